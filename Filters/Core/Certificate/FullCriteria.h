// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FullCriteria.h
 * @brief Steps 5 to 7 of the certificate, see MeshCertificate.h.
 */
#ifndef cdmFullCriteria_h
#define cdmFullCriteria_h

#include "Core/Certificate/BasicChecks.h"

namespace cdm
{
/** After CheckBasics(). */
Status EvaluateFullCriteria(const TetMesh& mesh, const TriangleMesh* boundary,
  const SphereCriteria& criteria, const BasicFindings& findings, const CertificateOptions& options,
  const ExecutionContext& context, MeshCertificate& certificate);
} // namespace cdm

#endif
