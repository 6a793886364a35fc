// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedPoints.h"

#include "CoreBridge/Inputs.h"

#include <vtkDataSetAttributes.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkTable.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <string>

namespace vtkDistributed
{
namespace
{
/** Points that the cuts of space are found with, at least and for each process. */
constexpr std::int64_t SampleSize = 20000;
constexpr std::int64_t SampleSizeOfProcess = 1000;

bool IsLessByNumber(const cdm::NumberedPoint& p, const cdm::NumberedPoint& q)
{
  return p.Number < q.Number;
}
} // namespace

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedPoints::Read(vtkPointSet* input, const char* name, int port)
{
  std::vector<cdm::Vec3> positions;
  const cdm::Status status =
    input ? vtkCoreBridge::ToPoints(input, name, positions) : cdm::Status();
  for (const cdm::Vec3& position : positions)
  {
    this->Pieces[port].Points.push_back({ position, 0 });
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedPoints::Number(vtkPointSet* input, vtkPointSet* meshPoints)
{
  cdm::Status status =
    this->Processes.Agree(this->NumberPoints(input, 0))
      .Then([&] { return this->Processes.Agree(this->NumberPoints(meshPoints, 1)); })
      .Then([&] { return this->HasGlobalIds ? this->CheckNumbers() : cdm::Status(); });
  if (status.IsOk())
  {
    this->ChooseArrays(input, meshPoints);
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
/**
 * Numbers the points: by their global ids if all points of the input have them, otherwise one
 * process after another.
 */
cdm::Status DistributedPoints::NumberPoints(vtkPointSet* input, int port)
{
  std::vector<cdm::NumberedPoint>& points = this->Pieces[port].Points;
  vtkDataArray* ids = points.empty() ? nullptr : input->GetPointData()->GetGlobalIds();
  const bool hasIds = this->Processes.Sum(points.empty() || ids ? 0 : 1) == 0 &&
    this->Processes.Sum(points.empty() ? 0 : 1) > 0;
  this->HasGlobalIds = this->HasGlobalIds || hasIds;
  std::int64_t highest = -1;
  for (const cdm::NumberedPoint& point : this->Pieces[0].Points)
  {
    highest = std::max(highest, point.Number);
  }
  std::int64_t next = port == 0 ? 0 : this->Processes.Maximum(highest) + 1;
  if (port == 1)
  {
    this->FirstMeshPoint = next;
  }
  const std::vector<std::int64_t> counts = this->Processes.GatherAll(
    std::vector<std::int64_t>{ static_cast<std::int64_t>(points.size()) });
  if (!hasIds)
  {
    next = std::accumulate(counts.begin(), counts.begin() + this->Processes.GetRank(), next);
  }
  bool isNegative = false;
  vtkIdTypeArray* exact = vtkIdTypeArray::SafeDownCast(ids);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const vtkIdType place = static_cast<vtkIdType>(i);
    const std::int64_t id = !hasIds ? place
      : exact                       ? exact->GetValue(place)
                                    : static_cast<std::int64_t>(ids->GetTuple1(place));
    isNegative = isNegative || id < 0;
    points[i].Number = next + id;
  }
  return isNegative ? cdm::Status::InvalidInput(
                        "Global point ids of the input are negative. Correct or remove them.")
                    : cdm::Status();
}

//--------------------------------------------------------------------------------------------------
/** Global ids of the input must not be those of two points. */
cdm::Status DistributedPoints::CheckNumbers()
{
  std::vector<std::vector<cdm::NumberedPoint>> messages(
    static_cast<std::size_t>(this->Processes.GetSize()));
  for (const Piece& piece : this->Pieces)
  {
    for (const cdm::NumberedPoint& point : piece.Points)
    {
      messages[point.Number % this->Processes.GetSize()].push_back(point);
    }
  }
  std::vector<std::vector<cdm::NumberedPoint>> received;
  const cdm::Status status = this->Processes.Exchange(messages, received);
  if (!status.IsOk())
  {
    return status;
  }
  return this->Processes.Do(
    [&]
    {
      std::vector<cdm::NumberedPoint> points;
      for (const auto& message : received)
      {
        points.insert(points.end(), message.begin(), message.end());
      }
      std::sort(points.begin(), points.end(), IsLessByNumber);
      const auto wrong = std::adjacent_find(points.begin(), points.end(),
        [](const cdm::NumberedPoint& p, const cdm::NumberedPoint& q)
        { return p.Number == q.Number && p.Position != q.Position; });
      return wrong == points.end()
        ? cdm::Status()
        : cdm::Status::InvalidInput("Two points of the input at different places have the global "
                                    "id " +
            std::to_string(wrong->Number) + ". Correct or remove the global ids.");
    });
}

//--------------------------------------------------------------------------------------------------
/** Chooses the arrays that all processes have in both inputs. */
void DistributedPoints::ChooseArrays(vtkPointSet* input, vtkPointSet* meshPoints)
{
  std::set<std::string> common;
  bool isFirst = true;
  vtkPointSet* const inputs[2] = { input, meshPoints };
  for (vtkPointSet* points : inputs)
  {
    const bool hasPoints = points && points->GetNumberOfPoints() > 0;
    const std::set<std::string> here = Intersect(this->Processes,
      hasPoints ? GetSignatures(points->GetPointData()) : std::set<std::string>(), hasPoints);
    if (this->Processes.Sum(hasPoints ? 1 : 0) == 0)
    {
      continue;
    }
    std::set<std::string> both;
    std::set_intersection(
      common.begin(), common.end(), here.begin(), here.end(), std::inserter(both, both.begin()));
    common = isFirst ? here : both;
    isFirst = false;
  }
  this->HasArrays = !common.empty();
  for (int port = 0; port < 2; ++port)
  {
    this->Pieces[port].Data = vtkSmartPointer<vtkDataSetAttributes>::New();
    if (inputs[port])
    {
      PassArrays(inputs[port]->GetPointData(), common, this->Pieces[port].Data);
    }
  }
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedPoints::Distribute(
  std::int64_t firstCounted, std::vector<cdm::NumberedPoint>& own, vtkIdType& numberOfCopies)
{
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  const std::int64_t numberOfPoints =
    static_cast<std::int64_t>(this->Pieces[0].Points.size() + this->Pieces[1].Points.size());
  const std::int64_t size =
    std::max(SampleSize, SampleSizeOfProcess * static_cast<std::int64_t>(count));
  const std::int64_t step = std::max<std::int64_t>(1, this->Processes.Sum(numberOfPoints) / size);
  std::vector<cdm::Vec3> sample;
  std::int64_t next = 0;
  for (const Piece& piece : this->Pieces)
  {
    for (const cdm::NumberedPoint& point : piece.Points)
    {
      if (next++ % step == 0)
      {
        sample.push_back(point.Position);
      }
    }
  }
  this->Partition = std::make_unique<cdm::SpacePartition>(
    this->Processes.GatherAll(sample), this->Processes.GetSize());

  std::vector<cdm::NumberedPoint> all;
  std::vector<Row> rows;
  for (const Piece& piece : this->Pieces)
  {
    std::vector<std::vector<cdm::NumberedPoint>> messages(count);
    std::vector<std::vector<vtkIdType>> rowsOfPart(count);
    for (std::size_t i = 0; i < piece.Points.size(); ++i)
    {
      const std::size_t part = static_cast<std::size_t>(this->GetOwner(piece.Points[i].Position));
      messages[part].push_back(piece.Points[i]);
      rowsOfPart[part].push_back(static_cast<vtkIdType>(i));
    }
    std::vector<ProcessGroup::Bytes> tables(count);
    const auto pack = [&]
    {
      for (std::size_t part = 0; part < count; ++part)
      {
        if (!rowsOfPart[part].empty() && piece.Data->GetNumberOfArrays() > 0)
        {
          tables[part] = Pack(Select(piece.Data, rowsOfPart[part]));
        }
      }
      return cdm::Status();
    };
    std::vector<std::vector<cdm::NumberedPoint>> points;
    std::vector<ProcessGroup::Bytes> receivedTables;
    cdm::Status status =
      this->Processes.Do(pack)
        .Then([&] { return this->Processes.Exchange(messages, points); })
        .Then([&] { return this->Processes.Exchange(std::move(tables), receivedTables); });
    if (!status.IsOk())
    {
      return status;
    }
    for (std::size_t part = 0; part < count; ++part)
    {
      for (std::size_t i = 0; i < points[part].size(); ++i)
      {
        all.push_back(points[part][i]);
        rows.emplace_back(this->Tables.size(), static_cast<vtkIdType>(i));
      }
      const ProcessGroup::Bytes& bytes = receivedTables[part];
      this->Tables.emplace_back(Unpack(bytes));
    }
  }
  own = all;
  cdm::RemoveCopies(own);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
    [&all](std::size_t a, std::size_t b) { return all[a].Number < all[b].Number; });
  std::size_t place = 0;
  for (const cdm::NumberedPoint& point : own)
  {
    while (all[order[place]].Number != point.Number)
    {
      ++place;
    }
    this->Rows.push_back(rows[order[place]]);
  }
  const auto countFrom = [firstCounted](const std::vector<cdm::NumberedPoint>& points)
  {
    return std::count_if(points.begin(), points.end(),
      [firstCounted](const cdm::NumberedPoint& point) { return point.Number >= firstCounted; });
  };
  numberOfCopies = countFrom(all) - countFrom(own);
  return {};
}

//--------------------------------------------------------------------------------------------------
cdm::Status DistributedPoints::FetchData(const std::vector<cdm::NumberedPoint>& points,
  cdm::Id numberOfOwnPoints, const std::vector<char>& isUsed)
{
  if (!this->HasArrays)
  {
    return {};
  }
  const std::size_t count = static_cast<std::size_t>(this->Processes.GetSize());
  this->Rows.resize(points.size());
  std::vector<std::vector<std::int64_t>> requests(count);
  for (std::size_t i = static_cast<std::size_t>(numberOfOwnPoints); i < isUsed.size(); ++i)
  {
    if (isUsed[i])
    {
      std::vector<std::int64_t>& request = requests[this->GetOwner(points[i].Position)];
      this->Rows[i] = { static_cast<std::size_t>(this->GetOwner(points[i].Position)) +
          this->Tables.size(),
        static_cast<vtkIdType>(request.size()) };
      request.push_back(points[i].Number);
    }
  }
  std::vector<std::vector<std::int64_t>> asked;
  std::vector<ProcessGroup::Bytes> answers(count);
  const auto answer = [&]
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      std::vector<Row> rows;
      for (std::int64_t number : asked[i])
      {
        const auto place = std::lower_bound(points.begin(), points.begin() + numberOfOwnPoints,
          cdm::NumberedPoint{ {}, number }, IsLessByNumber);
        rows.push_back(this->Rows[place - points.begin()]);
      }
      if (!rows.empty())
      {
        vtkNew<vtkTable> table;
        Merge(this->Tables, rows, table->GetRowData());
        answers[i] = Pack(table);
      }
    }
    return cdm::Status();
  };
  std::vector<ProcessGroup::Bytes> received;
  cdm::Status status =
    this->Processes.Exchange(requests, asked)
      .Then([&] { return this->Processes.Do(answer); })
      .Then([&] { return this->Processes.Exchange(std::move(answers), received); });
  for (const ProcessGroup::Bytes& bytes : received)
  {
    this->Tables.emplace_back(Unpack(bytes));
  }
  return status;
}

//--------------------------------------------------------------------------------------------------
void DistributedPoints::CopyData(const std::vector<cdm::Id>& places, vtkDataSetAttributes* to) const
{
  std::vector<Row> rows;
  for (cdm::Id place : places)
  {
    rows.push_back(this->HasArrays ? this->Rows[place] : Row());
  }
  Merge(this->Tables, rows, to);
}
} // namespace vtkDistributed
