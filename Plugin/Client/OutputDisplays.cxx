// SPDX-License-Identifier: BSD-3-Clause
#include "OutputDisplays.h"

#include "OwnSources.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqView.h>

#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMViewProxy.h>

#include <QPointer>
#include <QTimer>

#include <cstring>

namespace
{
constexpr const char* RegionIdName = "RegionId";

/** The cell array by which an output is colored; null if it has none of them. */
const char* FindColors(vtkPVDataInformation* information)
{
  for (const char* name : { "ProblemKind", "Fault", RegionIdName })
  {
    if (information->GetArrayInformation(name, vtkDataObject::CELL))
    {
      return name;
    }
  }
  return nullptr;
}

bool HasCells(pqOutputPort* port)
{
  vtkPVDataInformation* information = port->getDataInformation();
  return information && information->GetNumberOfCells() > 0;
}

/** Thick lines, in front of the polygons that they are on. */
void SetLines(vtkSMProxy* proxy)
{
  constexpr double lineWidth = 4.0;
  constexpr double pointSize = 10.0;
  vtkSMPropertyHelper(proxy, "LineWidth", true).Set(lineWidth);
  vtkSMPropertyHelper(proxy, "PointSize", true).Set(pointSize);
  vtkSMPropertyHelper(proxy, "RenderLinesAsTubes", true).Set(1);
}

bool IsColoredBy(vtkSMProxy* proxy, const char* name)
{
  const char* colors =
    vtkSMPropertyHelper(proxy, "ColorArrayName", true).GetInputArrayNameToProcess();
  return colors && std::strcmp(colors, name) == 0;
}
} // namespace

//--------------------------------------------------------------------------------------------------
void OutputDisplays::Start()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    new OutputDisplays(core);
  }
}

//--------------------------------------------------------------------------------------------------
OutputDisplays::OutputDisplays(QObject* parent) : QObject(parent)
{
  pqServerManagerModel* model = pqApplicationCore::instance()->getServerManagerModel();
  this->connect(model, &pqServerManagerModel::representationAdded, this, &OutputDisplays::Watch);
}

//--------------------------------------------------------------------------------------------------
void OutputDisplays::Watch(pqRepresentation* representation)
{
  const QPointer<pqDataRepresentation> data = qobject_cast<pqDataRepresentation*>(representation);
  if (!data)
  {
    return;
  }
  const auto update = [this, data]()
  {
    // Not while ParaView is at work on the same display.
    QTimer::singleShot(0, this,
      [this, data]()
      {
        if (data)
        {
          this->Update(data);
        }
      });
  };
  update();
  this->connect(data, &pqDataRepresentation::dataUpdated, this, update);
  this->connect(
    data, &QObject::destroyed, this, [this](QObject* object) { this->Displays.remove(object); });
}

//--------------------------------------------------------------------------------------------------
void OutputDisplays::Update(pqDataRepresentation* representation)
{
  pqOutputPort* port = representation->getOutputPortFromInput();
  auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(representation->getProxy());
  vtkPVDataInformation* information = port ? port->getDataInformation() : nullptr;
  if (!proxy || !information || !OwnSources::IsOurs(port->getSource()))
  {
    return;
  }
  const bool isNew = !this->Displays.contains(representation);
  Display& known = this->Displays[representation];
  const Display before = known;
  known.HasCells = HasCells(port);
  known.HasMesh = HasCells(port->getSource()->getOutputPort(0));
  known.WasEmpty = before.WasEmpty || !known.HasCells;
  const char* name = FindColors(information);
  if (!name || (known.HasCells == before.HasCells && known.HasMesh == before.HasMesh && !isNew))
  {
    return;
  }
  const bool isMesh = std::strcmp(name, RegionIdName) == 0;
  const bool isFirst = known.HasCells && !before.HasCells;
  if (isFirst && before.WasEmpty && !proxy->GetUsingScalarColoring())
  {
    proxy->SetScalarColoring(name, vtkDataObject::CELL);
  }
  if (isFirst && !isMesh)
  {
    SetLines(proxy);
  }
  if (known.HasCells && std::strcmp(name, "ProblemKind") == 0)
  {
    vtkSMPropertyHelper(proxy, "Representation").Set(known.HasMesh ? "Wireframe" : "Surface");
  }
  vtkSMViewProxy* view = representation->getViewProxy();
  if (view && representation->isVisible() && IsColoredBy(proxy, name) &&
    (isFirst || (!known.HasCells && !isMesh)))
  {
    proxy->SetScalarBarVisibility(view, known.HasCells);
  }
  proxy->UpdateVTKObjects();
  if (pqView* shown = representation->getView())
  {
    shown->forceRender();
  }
}
