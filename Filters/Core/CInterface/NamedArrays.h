// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NamedArrays.h
 * @brief Arrays and options by name, as cdmEngine.h hands them to stages and back.
 */
#ifndef cdmNamedArrays_h
#define cdmNamedArrays_h

#include "Core/Basics/Status.h"
#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/CInterface/cdmEngine.h"

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/** The named arrays of an input or of an output. */
struct cdmArrays
{
  using Input = std::variant<std::vector<double>, std::vector<std::int64_t>>;

  struct Output
  {
    /** Keeps the values. */
    std::shared_ptr<const void> Owner;
    const void* Values = nullptr;
    cdmType Type = cdmReal64;
    std::int64_t Count = 0;
    int Components = 1;
  };

  std::map<std::string, Input> Inputs;
  std::map<std::string, Output> Outputs;
};

namespace cdm
{
/**
 * Reads inputs of a stage. What is missing leaves the value as it is. The first thing that is wrong
 * is kept: a wrong type or length, a value out of its range, and, in Finish(), a name that the
 * stage has not asked for.
 */
class InputReader
{
public:
  explicit InputReader(const cdmArrays& arrays) : Arrays(arrays) {}

  bool Has(const char* name) const { return this->Arrays.Inputs.count(name) > 0; }

  void Read(const char* name, bool& value);
  void Read(const char* name, double& value, double low, double high);
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  void Read(const char* name, Integer& value, std::int64_t low, std::int64_t high)
  {
    std::int64_t read = static_cast<std::int64_t>(value);
    this->ReadInteger(name, read, low, high);
    value = static_cast<Integer>(read);
  }
  /** A number of one of the enumerators from the first to the last. */
  template <class Enumeration, std::enable_if_t<std::is_enum_v<Enumeration>, int> = 0>
  void Read(const char* name, Enumeration& value, Enumeration first, Enumeration last)
  {
    std::int64_t read = static_cast<std::int64_t>(value);
    this->ReadInteger(
      name, read, static_cast<std::int64_t>(first), static_cast<std::int64_t>(last));
    value = static_cast<Enumeration>(read);
  }
  void Read(const char* name, std::vector<double>& values);
  void Read(const char* name, std::vector<Id>& values);
  /** Ids from 0 on, below a number. */
  void ReadIds(const char* name, std::vector<Id>& values, std::size_t number);
  void Read(const char* name, std::vector<Vec3>& values);
  void Read(const char* name, std::vector<RegionPair>& values);
  /** 0 or 1 for each. */
  void Read(const char* name, std::vector<char>& values);

  /** Ids of arrays of so many components. */
  template <std::size_t Components, class Allocator>
  void ReadTuples(const char* name, std::vector<std::array<Id, Components>, Allocator>& values,
    std::size_t number)
  {
    std::vector<Id> ids;
    this->ReadIds(name, ids, number);
    if (this->CheckSize(name, ids.size(), Components))
    {
      values.resize(ids.size() / Components);
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        values[i / Components][i % Components] = ids[i];
      }
    }
  }

  /** Whether two arrays fit: one is empty, or they have as many tuples. */
  void Match(const char* name, std::size_t count, std::size_t expected);
  void Fail(std::string message);

  Status Finish();

private:
  /** Reads one number between two bounds. */
  template <class Number>
  void ReadNumber(const char* name, const char* kind, Number& value, Number low, Number high);
  void ReadInteger(const char* name, std::int64_t& value, std::int64_t low, std::int64_t high);
  bool CheckSize(const char* name, std::size_t count, std::size_t components);
  template <class T>
  const std::vector<T>* Find(const char* name, const char* kind);

  const cdmArrays& Arrays;
  std::set<std::string> Names;
  std::string Problem;
};

/** Hands arrays of a stage out, without a copy. */
class OutputWriter
{
public:
  explicit OutputWriter(cdmArrays& arrays) : Arrays(arrays) {}

  void Write(const std::string& name, double value);
  void Write(const std::string& name, std::int64_t value);
  void Write(const std::string& name, std::string text);
  /** Hands out a vector of numbers, of arrays of ids, of points or of pairs of regions. */
  template <class T, class Allocator>
  void Write(const std::string& name, std::vector<T, Allocator> values)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    using Scalar = std::conditional_t<std::is_same_v<T, Vec3> || std::is_same_v<T, double>, double,
      std::conditional_t<sizeof(T) == 1, char, Id>>;
    constexpr std::size_t size = sizeof(T);
    constexpr std::size_t scalarSize = sizeof(Scalar);
    static_assert(size % scalarSize == 0);
    const auto owner = std::make_shared<const std::vector<T, Allocator>>(std::move(values));
    this->Arrays.Outputs[name] = { owner, owner->data(),
      std::is_same_v<Scalar, double>   ? cdmReal64
        : std::is_same_v<Scalar, char> ? cdmUInt8
                                       : cdmInt32,
      static_cast<std::int64_t>(owner->size()), static_cast<int>(size / scalarSize) };
  }

private:
  cdmArrays& Arrays;
};
} // namespace cdm

#endif
