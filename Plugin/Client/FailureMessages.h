// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FailureMessages.h
 * @brief The part of the plugin for the ParaView GUI alone: what a failed filter says comes last.
 *
 * When a filter fails VTK's pipeline adds a message of its own, which names requests and addresses.
 * The window Output Messages leaves it out if the filter is one of this plugin, which has said what
 * is wrong. Other consoles show both.
 */
#ifndef FailureMessages_h
#define FailureMessages_h

namespace FailureMessages
{
/** If this process has the GUI; called when the plugin is loaded. */
void Start();
} // namespace FailureMessages

#endif
