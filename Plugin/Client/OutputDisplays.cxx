// SPDX-License-Identifier: BSD-3-Clause
#include "OutputDisplays.h"

#include "OwnSources.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqView.h>

#include <vtkClientServerStream.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMOutputPort.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSession.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMViewProxy.h>

#include <QTimer>

#include <cstring>

namespace
{
constexpr const char* RegionIdName = "RegionId";

constexpr const char* ProblemKindName = "ProblemKind";

vtkSMSourceProxy* GetProxy(pqPipelineSource* source)
{
  return vtkSMSourceProxy::SafeDownCast(source->getProxy());
}

/** The cell array by which an output is colored; null if it has none of them. */
const char* FindColors(pqOutputPort* port)
{
  vtkPVDataInformation* information = port->getDataInformation();
  for (const char* name : { ProblemKindName, "Fault", RegionIdName })
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
  return port->getDataInformation()->GetNumberOfCells() > 0;
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

/**
 * A display whose filter failed waits for data, and shows the former ones. ParaView takes it for
 * told already, so that its object has to be told itself.
 */
void AskAgain(vtkSMProxy* display)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(display) << "MarkModified"
         << vtkClientServerStream::End;
  display->GetSession()->ExecuteStream(display->GetLocation(), stream);
  display->MarkDirty(display);
}

vtkSMProxy* GetColorMap(vtkSMProxy* display)
{
  return vtkSMPropertyHelper(display, "LookupTable", true).GetAsProxy();
}

/** Whether what is visible in the view, other than this display, has cells with the same colors. */
bool IsColorMapShared(pqDataRepresentation* display)
{
  vtkSMProxy* colors = GetColorMap(display->getProxy());
  for (pqRepresentation* representation : display->getView()->getRepresentations())
  {
    auto* other = qobject_cast<pqDataRepresentation*>(representation);
    auto* proxy = other ? vtkSMPVRepresentationProxy::SafeDownCast(other->getProxy()) : nullptr;
    if (proxy && other != display && other->isVisible() && proxy->GetUsingScalarColoring() &&
      GetColorMap(proxy) == colors && HasCells(other->getOutputPortFromInput()))
    {
      return true;
    }
  }
  return false;
}

/** Hides the legend of a display without cells, if it is that of nothing else; says if it was shown. */
bool HideLegend(pqDataRepresentation* representation)
{
  auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(representation->getProxy());
  vtkSMProxy* view = representation->getViewProxy();
  if (!proxy || !representation->isVisible() || !proxy->GetUsingScalarColoring() ||
    !proxy->IsScalarBarVisible(view) || IsColorMapShared(representation))
  {
    return false;
  }
  proxy->SetScalarBarVisibility(view, false);
  return true;
}

/** Shows or hides the problems of a mesh in a view, if ParaView leaves that to others. */
void ShowProblems(pqPipelineSource* source, vtkSMViewProxy* view, bool isShown)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  for (pqOutputPort* port : source->getOutputPorts())
  {
    const char* name = FindColors(port);
    const char* type = controller->GetPreferredViewType(GetProxy(source), port->getPortNumber());
    if (!name || std::strcmp(name, ProblemKindName) != 0 || !type || std::strcmp(type, "None") != 0)
    {
      continue;
    }
    if (!isShown)
    {
      controller->Hide(GetProxy(source), port->getPortNumber(), view);
    }
    else if (HasCells(port))
    {
      if (auto* display = vtkSMPVRepresentationProxy::SafeDownCast(
            controller->Show(GetProxy(source), port->getPortNumber(), view)))
      {
        display->SetScalarBarVisibility(view, true);
      }
    }
  }
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
  for (pqView* view : model->findItems<pqView*>())
  {
    this->Watch(view);
  }
  this->connect(model, &pqServerManagerModel::viewAdded, this, &OutputDisplays::Watch);
}

//--------------------------------------------------------------------------------------------------
void OutputDisplays::Watch(pqView* view)
{
  this->connect(view, &pqView::updateDataEvent, this,
    [this, view]()
    {
      // Not while ParaView is at work on the same displays, nor while a filter runs: AbortBehavior
      // holds back timers, though not those of no time at all.
      QTimer::singleShot(1, view, [this, view]() { this->Update(view); });
    });
}

//--------------------------------------------------------------------------------------------------
void OutputDisplays::Update(pqView* view)
{
  QList<pqDataRepresentation*> displays;
  for (pqRepresentation* representation : view->getRepresentations())
  {
    auto* display = qobject_cast<pqDataRepresentation*>(representation);
    pqOutputPort* port = display ? display->getOutputPortFromInput() : nullptr;
    if (port && OwnSources::IsOurs(port->getSource()))
    {
      displays.append(display);
      for (pqOutputPort* output : port->getSource()->getOutputPorts())
      {
        output->getOutputPortProxy()->InvalidateDataInformation();
      }
    }
  }
  bool isChanged = false;
  for (pqDataRepresentation* display : displays)
  {
    isChanged = this->UpdateDisplay(display) || isChanged;
  }
  if (isChanged)
  {
    view->forceRender();
  }
}

//--------------------------------------------------------------------------------------------------
bool OutputDisplays::UpdateDisplay(pqDataRepresentation* representation)
{
  pqOutputPort* port = representation->getOutputPortFromInput();
  pqPipelineSource* source = port->getSource();
  const bool isNew = !this->Displays.contains(representation);
  if (isNew)
  {
    this->connect(representation, &QObject::destroyed, this,
      [this](QObject* object) { this->Displays.remove(object); });
  }
  Display& known = this->Displays[representation];
  const Display before = known;
  known.HasCells = HasCells(port);
  known.HasMesh = HasCells(source->getOutputPort(0));
  known.WasEmpty = before.WasEmpty || !known.HasCells;
  if (known.HasCells == before.HasCells && known.HasMesh == before.HasMesh && !isNew)
  {
    return false;
  }
  if (before.HasCells && !known.HasCells)
  {
    AskAgain(representation->getProxy());
  }
  if (port->getPortNumber() == 0 && representation->isVisible() && !(isNew && known.HasMesh))
  {
    ShowProblems(source, representation->getViewProxy(), !known.HasMesh);
  }
  known.LostLegend = !known.HasCells && (before.LostLegend || HideLegend(representation));
  SetLook(representation, known, before);
  return true;
}

//--------------------------------------------------------------------------------------------------
void OutputDisplays::SetLook(
  pqDataRepresentation* representation, const Display& known, const Display& before)
{
  auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(representation->getProxy());
  const char* name = FindColors(representation->getOutputPortFromInput());
  if (!proxy || !name)
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
  if (known.HasCells && std::strcmp(name, ProblemKindName) == 0)
  {
    vtkSMPropertyHelper(proxy, "Representation").Set(known.HasMesh ? "Wireframe" : "Surface");
  }
  if (isFirst && representation->isVisible() && proxy->GetUsingScalarColoring() &&
    (before.LostLegend || IsColoredBy(proxy, name)))
  {
    proxy->SetScalarBarVisibility(representation->getViewProxy(), true);
  }
  proxy->UpdateVTKObjects();
}
