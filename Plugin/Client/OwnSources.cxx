// SPDX-License-Identifier: BSD-3-Clause
#include "OwnSources.h"

#include <pqPipelineSource.h>

#include <vtkPVXMLElement.h>

#include <cstring>

//--------------------------------------------------------------------------------------------------
bool OwnSources::IsOurs(pqPipelineSource* source)
{
  vtkPVXMLElement* hints = source->getHints();
  vtkPVXMLElement* menu = hints ? hints->FindNestedElementByName("ShowInMenu") : nullptr;
  const char* category = menu ? menu->GetAttribute("category") : nullptr;
  return category && std::strcmp(category, "Conforming Delaunay") == 0;
}
