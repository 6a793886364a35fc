// SPDX-License-Identifier: BSD-3-Clause
#include "RegionColors.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqServerManagerModel.h>

#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSettings.h>

#include <QByteArray>
#include <QMap>
#include <QPointer>
#include <QStringList>
#include <QTimer>
#include <QUrl>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace
{
constexpr const char* RegionIdName = "RegionId";
/** Settings of ParaView. The colors of regions are those of Macros/region_cut.py. */
constexpr const char* ColorMaps = R"({
  "standard_presets" : {
    "ProblemKind" : "Brewer Qualitative Set3",
    "RefinementFault" : "Brewer Qualitative Set3"
  },
  "array_lookup_tables" : {
    "RegionId" : {
      "PVLookupTable" : {
        "IndexedLookup" : 1,
        "IndexedColors" : [
          0.49, 0.65, 0.84, 0.96, 0.74, 0.24, 0.82, 0.34, 0.32, 0.55, 0.75, 0.48,
          0.66, 0.53, 0.78, 0.95, 0.60, 0.40, 0.42, 0.73, 0.74, 0.93, 0.66, 0.74,
          0.71, 0.69, 0.45, 0.62, 0.62, 0.66, 0.31, 0.46, 0.66, 0.35, 0.66, 0.58
        ]
      }
    },
    "ProblemKind" : {
      "PVLookupTable" : {
        "Annotations" : [
          "0", "Self-intersection", "1", "Degenerate polygon", "2", "Duplicate polygon",
          "3", "Invalid outline", "4", "T-junction", "5", "Patched gap", "6", "Open edge",
          "7", "Reversed polygon"
        ]
      }
    },
    "RefinementFault" : {
      "PVLookupTable" : {
        "Annotations" : [
          "0", "None", "1", "Too large", "2", "Radius-edge ratio", "3", "Dihedral angle",
          "4", "Inevitable"
        ]
      }
    }
  }
})";
/** More regions than that are not told apart by colors and names. */
constexpr int MaximumNumberOfRegions = 64;

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

/** Names of the regions of what is shown; false if there are too many. */
bool AddTexts(pqDataRepresentation* representation, QMap<int, QString>& texts)
{
  const int association =
    vtkSMPropertyHelper(representation->getProxy(), "ColorArrayName").GetInputArrayAssociation();
  vtkPVDataInformation* information = representation->getInputDataInformation();
  vtkPVArrayInformation* regions =
    information ? information->GetArrayInformation(RegionIdName, association) : nullptr;
  if (!regions || regions->GetNumberOfTuples() == 0)
  {
    return true;
  }
  vtkPVArrayInformation* array =
    information->GetArrayInformation("RegionNames", vtkDataObject::FIELD);
  const QStringList names = array ? GetTexts(array) : QStringList();
  const double last = std::max(regions->GetComponentRange(0)[1], names.size() - 1.0);
  for (int region = 0; region <= last && region <= MaximumNumberOfRegions; ++region)
  {
    texts[region] = region < names.size() ? names[region] : QString("Region %1").arg(region);
  }
  return last < MaximumNumberOfRegions;
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
  bool isLegible = true;
  for (pqDataRepresentation* other :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqDataRepresentation*>())
  {
    isLegible = (GetColors(other) != colors || AddTexts(other, texts)) && isLegible;
  }
  if (!isLegible)
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
