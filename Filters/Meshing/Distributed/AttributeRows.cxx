// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/AttributeRows.h"

#include "CoreBridge/Tuples.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetAttributesFieldList.h>
#include <vtkTable.h>

#include <algorithm>
#include <iterator>

namespace
{
std::string GetSignature(vtkAbstractArray* array)
{
  return std::to_string(array->GetDataType()) + ' ' +
    std::to_string(array->GetNumberOfComponents()) + ' ' +
    (array->GetName() ? array->GetName() : "");
}
} // namespace

namespace vtkDistributed
{
//--------------------------------------------------------------------------------------------------
std::set<std::string> GetSignatures(vtkDataSetAttributes* data)
{
  std::set<std::string> signatures;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (array != data->GetGlobalIds() && array->GetName() &&
      std::string(array->GetName()) != vtkDataSetAttributes::GhostArrayName())
    {
      signatures.insert(GetSignature(array));
    }
  }
  return signatures;
}

//--------------------------------------------------------------------------------------------------
std::set<std::string> Intersect(
  const ProcessGroup& processes, const std::set<std::string>& own, bool hasAny)
{
  std::string text = hasAny ? "+" : "";
  for (const std::string& signature : own)
  {
    text += signature + '\n';
  }
  std::set<std::string> common;
  bool isFirst = true;
  for (const ProcessGroup::Bytes& bytes :
    processes.Gather(ProcessGroup::Bytes(text.begin(), text.end())))
  {
    if (bytes.empty())
    {
      continue;
    }
    std::set<std::string> there;
    for (auto begin = bytes.begin() + 1; begin != bytes.end();)
    {
      const auto end = std::find(begin, bytes.end(), '\n');
      there.emplace(begin, end);
      begin = end + 1;
    }
    std::set<std::string> both;
    std::set_intersection(
      common.begin(), common.end(), there.begin(), there.end(), std::inserter(both, both.begin()));
    common = isFirst ? there : both;
    isFirst = false;
  }
  return common;
}

//--------------------------------------------------------------------------------------------------
void PassArrays(
  vtkDataSetAttributes* from, const std::set<std::string>& signatures, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    if (signatures.count(GetSignature(from->GetAbstractArray(i))) != 0)
    {
      to->AddArray(from->GetAbstractArray(i));
    }
  }
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkTable> Select(vtkDataSetAttributes* from, const std::vector<vtkIdType>& rows)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkCoreBridge::CopyTuples(from, rows, table->GetRowData());
  return table;
}

//--------------------------------------------------------------------------------------------------
void Merge(const std::vector<vtkSmartPointer<vtkTable>>& tables, const std::vector<Row>& rows,
  vtkDataSetAttributes* to)
{
  vtkDataSetAttributes::FieldList fields;
  std::vector<int> places(tables.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < tables.size(); ++i)
  {
    if (tables[i] && tables[i]->GetNumberOfRows() > 0)
    {
      fields.IntersectFieldList(tables[i]->GetRowData());
      places[i] = count++;
    }
  }
  if (count == 0)
  {
    return;
  }
  fields.CopyAllocate(to, vtkDataSetAttributes::COPYTUPLE, static_cast<vtkIdType>(rows.size()), 0);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const auto& [table, row] = rows[i];
    fields.CopyData(places[table], tables[table]->GetRowData(), row, to, static_cast<vtkIdType>(i));
  }
}

//--------------------------------------------------------------------------------------------------
ProcessGroup::Bytes Pack(vtkTable* table)
{
  return ProcessGroup::Pack(static_cast<vtkDataObject*>(table));
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkTable> Unpack(const ProcessGroup::Bytes& bytes)
{
  return bytes.empty() ? nullptr : vtkTable::SafeDownCast(ProcessGroup::UnpackData(bytes));
}
} // namespace vtkDistributed
