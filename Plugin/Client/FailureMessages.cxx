// SPDX-License-Identifier: BSD-3-Clause
#include "FailureMessages.h"

#include "OwnSources.h"

#include <pqApplicationCore.h>
#include <pqOutputWidget.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>

#include <vtkSMProxy.h>

#include <QApplication>
#include <QSet>
#include <QString>

namespace
{
/** Leaves out what the pipeline says of the class of a source. */
void Watch(pqPipelineSource* source)
{
  static QSet<QString> known;
  const QString name = source->getProxy()->GetVTKClassName();
  if (!OwnSources::IsOurs(source) || known.contains(name))
  {
    return;
  }
  for (QWidget* widget : QApplication::allWidgets())
  {
    if (auto* output = qobject_cast<pqOutputWidget*>(widget))
    {
      // As vtkExecutive begins: "Algorithm vtkName(0x1234) returned failure for request: ".
      output->suppress({ "Algorithm " + name + "(", "Algorithm " + name + " (" });
      known.insert(name);
    }
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
void FailureMessages::Start()
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  if (!core)
  {
    return;
  }
  pqServerManagerModel* const model = core->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    Watch(source);
  }
  QObject::connect(model, &pqServerManagerModel::sourceAdded, core, &Watch);
}
