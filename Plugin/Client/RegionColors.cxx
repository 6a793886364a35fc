// SPDX-License-Identifier: BSD-3-Clause
#include "RegionColors.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqServerManagerModel.h>

#include <vtkAbstractArray.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVProminentValuesInformation.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSettings.h>
#include <vtkSmartPointer.h>
#include <vtkVariant.h>

#include <QByteArray>
#include <QMap>
#include <QPointer>
#include <QStringList>
#include <QTimer>
#include <QUrl>

#include <cstring>
#include <numeric>
#include <string>
#include <vector>

namespace
{
constexpr const char* RegionIdName = "RegionId";
/** Settings of ParaView. The build defines REGION_COLORS: those of Macros/region_cut.py. */
constexpr const char* ColorMaps = R"({
  "array_lookup_tables" : {
    "RegionId" : {
      "PVLookupTable" : {
        "IndexedLookup" : 1,
        "IndexedColors" : [ )" REGION_COLORS R"( ]
      }
    },
    "ProblemKind" : {
      "PVLookupTable" : {
        "IndexedLookup" : 1,
        "IndexedColors" : [
          0.86, 0.08, 0.10, 0.95, 0.60, 0.15, 0.55, 0.34, 0.68, 0.65, 0.34, 0.16,
          0.20, 0.48, 0.78, 0.30, 0.68, 0.33, 0.93, 0.25, 0.62, 0.25, 0.70, 0.75,
          0.93, 0.87, 0.80
        ],
        "Annotations" : [
          "0", "Self-intersection", "1", "Degenerate polygon", "2", "Duplicate polygon",
          "3", "Invalid outline", "4", "T-junction", "5", "Patched gap", "6", "Open edge",
          "7", "Reversed polygon", "8", "Intersecting polygon"
        ]
      }
    },
    "Fault" : {
      "PVLookupTable" : {
        "IndexedLookup" : 1,
        "IndexedColors" : [
          0.86, 0.08, 0.10, 0.93, 0.25, 0.62, 0.65, 0.34, 0.16, 0.95, 0.60, 0.15,
          0.96, 0.80, 0.25, 0.20, 0.48, 0.78, 0.45, 0.70, 0.90, 0.30, 0.68, 0.33,
          0.55, 0.34, 0.68, 0.75, 0.75, 0.78
        ],
        "Annotations" : [
          "0", "Inverted tetrahedron", "1", "Flat tetrahedron", "2", "Overfull facet",
          "3", "Non-Delaunay tetrahedron", "4", "Non-Delaunay facet", "5", "Filled facet sphere",
          "6", "Filled edge sphere", "7", "Open control volume", "8", "Negative coupling",
          "9", "Negative cotangent sum"
        ]
      }
    },
    "RefinementFault" : {
      "PVLookupTable" : {
        "IndexedLookup" : 1,
        "IndexedColors" : [
          0.80, 0.82, 0.85, 0.20, 0.48, 0.78, 0.95, 0.60, 0.15, 0.86, 0.08, 0.10,
          0.55, 0.34, 0.68
        ],
        "Annotations" : [
          "0", "None", "1", "Too large", "2", "Radius-edge ratio", "3", "Dihedral angle",
          "4", "Inevitable"
        ]
      }
    }
  }
})";
/** A legend of more regions than that does not fit on the screen. */
constexpr int MaximumNumberOfRegions = 30;

/** The map of categories by which regions are colored; null: they are not. */
vtkSMProxy* GetColors(pqDataRepresentation* representation)
{
  vtkSMProxy* proxy = representation->getProxy();
  const char* name =
    vtkSMPropertyHelper(proxy, "ColorArrayName", true).GetInputArrayNameToProcess();
  vtkSMProxy* colors = vtkSMPropertyHelper(proxy, "LookupTable", true).GetAsProxy();
  return representation->isVisible() && name && std::strcmp(name, RegionIdName) == 0 && colors &&
      vtkSMPropertyHelper(colors, "IndexedLookup").GetAsInt()
    ? colors
    : nullptr;
}

/** The regions of some data by an array; null if they have none. */
vtkPVArrayInformation* FindRegions(pqOutputPort* port, int association)
{
  vtkPVDataInformation* information = port->getDataInformation();
  vtkPVArrayInformation* regions =
    information ? information->GetArrayInformation(RegionIdName, association) : nullptr;
  return regions && regions->GetNumberOfTuples() > 0 && regions->GetNumberOfComponents() == 1
    ? regions
    : nullptr;
}

/** The first data upstream with these regions: filters that cut them open leave some out. */
pqOutputPort* FindOrigin(pqOutputPort* port, int association)
{
  for (;;)
  {
    auto* filter = qobject_cast<pqPipelineFilter*>(port->getSource());
    pqOutputPort* input = filter ? filter->getAnyInput() : nullptr;
    if (!input || !FindRegions(input, association))
    {
      return port;
    }
    port = input;
  }
}

/** All ids of regions, ascending. */
std::vector<int> FindIds(pqOutputPort* port, int association)
{
  vtkNew<vtkPVProminentValuesInformation> values;
  values->SetPortNumber(port->getPortNumber());
  values->SetFieldAssociation(vtkDataObject::GetAssociationTypeAsString(association));
  values->SetFieldName(RegionIdName);
  values->SetNumberOfComponents(1);
  // Every value, however rare, and however many there are.
  values->SetFraction(0.0);
  values->SetUncertainty(0.0);
  values->SetForce(true);
  port->getSource()->getProxy()->GatherInformation(values);
  std::vector<int> ids;
  const auto found =
    vtkSmartPointer<vtkAbstractArray>::Take(values->GetProminentComponentValues(0));
  for (vtkIdType i = 0; found && i < found->GetNumberOfValues(); ++i)
  {
    ids.push_back(found->GetVariantValue(i).ToInt());
  }
  return ids;
}

/** A list of texts: strings, or names of components, see Filters/Meshing/CoreBridge/Texts.h. */
QStringList GetTexts(vtkPVArrayInformation* array)
{
  QStringList texts;
  if (array->GetDataType() == VTK_STRING)
  {
    for (int i = 0; i < array->GetNumberOfStringValues(); ++i)
    {
      texts.append(QString::fromUtf8(array->GetStringValue(i)));
    }
    return texts;
  }
  QMap<int, QByteArray> encoded;
  for (int i = 0; i < array->GetNumberOfComponents(); ++i)
  {
    encoded[static_cast<int>(array->GetComponentRange(i)[0])] += array->GetComponentName(i);
  }
  for (const QByteArray& text : encoded)
  {
    texts.append(QUrl::fromPercentEncoding(text));
  }
  return texts;
}

/** Adds the names of the regions of what is shown: all that have a name, or all that are there. */
void AddTexts(pqDataRepresentation* representation, QMap<int, QString>& texts)
{
  const int association =
    vtkSMPropertyHelper(representation->getProxy(), "ColorArrayName").GetInputArrayAssociation();
  pqOutputPort* port = representation->getOutputPortFromInput();
  if (!port || !FindRegions(port, association))
  {
    return;
  }
  port = FindOrigin(port, association);
  vtkPVArrayInformation* array =
    port->getDataInformation()->GetArrayInformation("RegionNames", vtkDataObject::FIELD);
  const QStringList names = array ? GetTexts(array) : QStringList();
  const int numberOfNames = static_cast<int>(names.size());
  std::vector<int> ids(numberOfNames);
  std::iota(ids.begin(), ids.end(), 0);
  if (FindRegions(port, association)->GetComponentRange(0)[1] >= numberOfNames)
  {
    ids = FindIds(port, association);
  }
  for (const int region : ids)
  {
    const QString name = region < numberOfNames && region >= 0 ? names[region] : QString();
    texts[region] = name.isEmpty() ? QString("Region %1").arg(region) : name;
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
void RegionColors::Start()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    // Below the settings of the user and of the site.
    vtkSMSettings::GetInstance()->AddCollectionFromString(ColorMaps, 0.0);
    new RegionColors(core);
  }
}

//--------------------------------------------------------------------------------------------------
RegionColors::RegionColors(QObject* parent) : QObject(parent)
{
  pqServerManagerModel* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqRepresentation* representation : model->findItems<pqRepresentation*>())
  {
    this->Watch(representation);
  }
  this->connect(model, &pqServerManagerModel::representationAdded, this, &RegionColors::Watch);
}

//--------------------------------------------------------------------------------------------------
void RegionColors::Watch(pqRepresentation* representation)
{
  const QPointer<pqDataRepresentation> data = qobject_cast<pqDataRepresentation*>(representation);
  if (!data)
  {
    return;
  }
  const auto update = [this, data]()
  {
    // Not while ParaView is at work on the same color map.
    QTimer::singleShot(0, this,
      [this, data]()
      {
        if (data)
        {
          this->Update(data);
        }
      });
  };
  this->connect(data, &pqDataRepresentation::dataUpdated, this, update);
  this->connect(data, &pqDataRepresentation::colorTransferFunctionModified, this, update);
  this->connect(data, &pqRepresentation::visibilityChanged, this, update);
}

//--------------------------------------------------------------------------------------------------
void RegionColors::Update(pqDataRepresentation* representation)
{
  vtkSMProxy* colors = GetColors(representation);
  if (!colors)
  {
    return;
  }
  QMap<int, QString> texts;
  for (pqDataRepresentation* other :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqDataRepresentation*>())
  {
    if (GetColors(other) == colors)
    {
      AddTexts(other, texts);
    }
  }
  if (texts.size() > MaximumNumberOfRegions)
  {
    vtkSMPropertyHelper(colors, "IndexedLookup").Set(0);
    colors->UpdateVTKObjects();
    if (auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(representation->getProxy()))
    {
      proxy->RescaleTransferFunctionToDataRange();
    }
    representation->renderViewEventually();
  }
  // Data are empty after an error, and will be back.
  else if (!texts.empty() && this->SetTexts(colors, texts))
  {
    representation->renderViewEventually();
  }
}

//--------------------------------------------------------------------------------------------------
bool RegionColors::SetTexts(vtkSMProxy* colors, QMap<int, QString> texts)
{
  vtkSMPropertyHelper annotations(colors, "Annotations");
  std::vector<std::string> entries;
  bool isChanged = false;
  for (unsigned int i = 0; i + 1 < annotations.GetNumberOfElements(); i += 2)
  {
    const QString value = annotations.GetAsString(i);
    const QString text = annotations.GetAsString(i + 1);
    const int region = value.toInt();
    // ParaView's own texts are the values.
    const bool isOurs = region >= 0 && (text == value || text == this->Texts.value(region));
    const bool isThere = texts.contains(region);
    const QString newText = isOurs && isThere ? texts[region] : text;
    texts.remove(region);
    isChanged = isChanged || newText != text || (isOurs && !isThere);
    if (isOurs && isThere)
    {
      this->Texts[region] = newText;
    }
    if (isThere || !isOurs)
    {
      entries.push_back(value.toStdString());
      entries.push_back(newText.toStdString());
    }
  }
  isChanged = isChanged || !texts.empty();
  for (auto text = texts.cbegin(); text != texts.cend(); ++text)
  {
    entries.push_back(std::to_string(text.key()));
    entries.push_back(text.value().toStdString());
    this->Texts[text.key()] = text.value();
  }
  if (isChanged)
  {
    annotations.SetNumberOfElements(static_cast<unsigned int>(entries.size()));
    for (unsigned int i = 0; i < entries.size(); ++i)
    {
      annotations.Set(i, entries[i].c_str());
    }
    colors->UpdateVTKObjects();
  }
  return isChanged;
}
