// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Texts.h
 * @brief Texts in field data, in a form that every reader of VTK's files takes.
 *
 * VTK's writers store a vtkStringArray as an array of the type String, at which other readers stop
 * (meshio: "Illegal data type 'String'"). So a list of texts is a vtkIntArray of one tuple: each component
 * has the index of a text as its value, and the text, or the next piece of it, as its name. Writers of
 * VTK keep names of components, and ParaView's client knows them without fetching the data. As these
 * writers put names into XML as they are, all but printable ASCII, and the characters "&'<>%, are
 * percent-encoded (RFC 3986). Pieces are short, as readers of the legacy format take 255 characters,
 * spaces as three of them.
 */
#ifndef CoreBridge_Texts_h
#define CoreBridge_Texts_h

#include <string>
#include <vector>

class vtkFieldData;

namespace vtkCoreBridge
{
/** Adds or replaces a list of texts; an empty one is none. */
void SetTexts(const char* name, const std::vector<std::string>& texts, vtkFieldData* data);

/** From SetTexts(), or from a vtkStringArray as users make them; empty if there is none. */
std::vector<std::string> GetTexts(const char* name, vtkFieldData* data);

/** Lets the files of an output be read: RegionNames and ContactNames of users as of SetTexts(). */
void EncodeNames(vtkFieldData* data);
} // namespace vtkCoreBridge

#endif
