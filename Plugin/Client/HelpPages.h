// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HelpPages.h
 * @brief The part of the plugin for the ParaView GUI alone: its help pages are found with Qt 6.
 *
 * ParaView asks plugins for their help pages when help is wanted first. With Qt 6 its help engine
 * takes none, as that is read-only unless told otherwise.
 */
#ifndef HelpPages_h
#define HelpPages_h

namespace HelpPages
{
/** Lets the help engine take pages; called when the plugin is loaded. */
void Start();
} // namespace HelpPages

#endif
