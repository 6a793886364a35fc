// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Certificates.h
 * @brief The certificate of a mesh in its field data.
 */
#ifndef CoreBridge_Certificates_h
#define CoreBridge_Certificates_h

#include "Core/Certificate/MeshCertificate.h"

class vtkFieldData;

namespace vtkCoreBridge
{
/**
 * The texts Certificate (the lines of MeshCertificate::GetText(), see Texts.h), IsClean, one count for
 * each kind of fault, and the numbers of what was looked at.
 */
void AddCertificate(const cdm::MeshCertificate& certificate, vtkFieldData* data);

/** What AddCertificate() has written: a filter that changes the mesh takes it away. */
void RemoveCertificate(vtkFieldData* data);
} // namespace vtkCoreBridge

#endif
