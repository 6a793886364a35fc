// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OwnSources.h
 * @brief Which sources and filters in the pipeline browser are those of this plugin.
 */
#ifndef OwnSources_h
#define OwnSources_h

class pqPipelineSource;

namespace OwnSources
{
/** Whether a source is one of this plugin, by its place in the menus. */
bool IsOurs(pqPipelineSource* source);
} // namespace OwnSources

#endif
