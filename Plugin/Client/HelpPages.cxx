// SPDX-License-Identifier: BSD-3-Clause
#include "HelpPages.h"

#include <pqApplicationCore.h>

#include <QVariant>

//--------------------------------------------------------------------------------------------------
void HelpPages::Start()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  if (!core)
  {
    return;
  }
  // Makes it if it is not there. By the name of its class, as Qt's help module need not be there.
  core->helpEngine();
  for (QObject* child : core->children())
  {
    if (child->inherits("QHelpEngineCore"))
    {
      child->setProperty("readOnly", false);
    }
  }
}
