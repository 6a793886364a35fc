// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Macros.h
 * @brief The part of the plugin for the ParaView GUI alone: its macros are in the menu Macros.
 *
 * Method: the scripts in the folder Macros beside the plugin are given to ParaView's list of macros
 * once its window is there, and again whenever it makes the list anew. Nothing is copied into the user's folder, so that a newer plugin brings
 * newer macros. A name is that of the script, "Region cut" for region_cut.py.
 */
#ifndef Macros_h
#define Macros_h

namespace Macros
{
/** If this process has the GUI; called when the plugin is loaded. */
void Start();
} // namespace Macros
#endif
