// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AttributeRows.h
 * @brief Tuples of point or cell arrays on their way between processes.
 *
 * Private to this module. A table holds the tuples that belong together, one in each row. Arrays of
 * global ids and marks of ghosts stay behind: who receives them makes its own.
 */
#ifndef AttributeRows_h
#define AttributeRows_h

#include "Distributed/ProcessGroup.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

class vtkDataSetAttributes;
class vtkTable;

namespace vtkDistributed
{
/** A table and a row in it. */
using Row = std::pair<std::size_t, vtkIdType>;

/** Type, components and name of each array. */
std::set<std::string> GetSignatures(vtkDataSetAttributes* data);

/** Names that are common to all processes that have any data. hasAny: whether this process has. */
std::set<std::string> Intersect(
  const ProcessGroup& processes, const std::set<std::string>& own, bool hasAny);

void PassArrays(
  vtkDataSetAttributes* from, const std::set<std::string>& signatures, vtkDataSetAttributes* to);

vtkSmartPointer<vtkTable> Select(vtkDataSetAttributes* from, const std::vector<vtkIdType>& rows);

/** The given rows of several tables, of which those that have none may be null. */
void Merge(const std::vector<vtkSmartPointer<vtkTable>>& tables, const std::vector<Row>& rows,
  vtkDataSetAttributes* to);

ProcessGroup::Bytes Pack(vtkTable* table);
/** null for no bytes. */
vtkSmartPointer<vtkTable> Unpack(const ProcessGroup::Bytes& bytes);
} // namespace vtkDistributed

#endif
