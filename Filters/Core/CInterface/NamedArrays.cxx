// SPDX-License-Identifier: BSD-3-Clause
#include "Core/CInterface/NamedArrays.h"

#include "Core/Basics/IdLimits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace cdm
{
namespace
{
template <class Number>
std::string ToText(Number number)
{
  std::ostringstream text;
  text << number;
  return text.str();
}
} // namespace

//--------------------------------------------------------------------------------------------------
template <class T>
const std::vector<T>* InputReader::Find(const char* name, const char* kind)
{
  this->Names.insert(name);
  const auto found = this->Arrays.Inputs.find(name);
  if (found == this->Arrays.Inputs.end())
  {
    return nullptr;
  }
  const auto* const values = std::get_if<std::vector<T>>(&found->second);
  if (!values)
  {
    this->Fail(std::string(name) + " has to be " + kind + ".");
  }
  return values;
}

bool InputReader::CheckSize(const char* name, std::size_t count, std::size_t components)
{
  if (count % components != 0)
  {
    this->Fail(std::string(name) + " has " + std::to_string(count) +
      " values, which are not rows of " + std::to_string(components) + ".");
    return false;
  }
  return true;
}

void InputReader::Read(const char* name, bool& value)
{
  std::int64_t read = value ? 1 : 0;
  this->ReadInteger(name, read, 0, 1);
  value = read != 0;
}

template <class Number>
void InputReader::ReadNumber(
  const char* name, const char* kind, Number& value, Number low, Number high)
{
  const std::vector<Number>* const values = this->Find<Number>(name, kind);
  if (!values)
  {
    return;
  }
  if (values->size() != 1 || !(values->front() >= low && values->front() <= high))
  {
    const bool isBounded = high < std::numeric_limits<Number>::max();
    this->Fail(std::string(name) + " is " +
      (values->size() == 1 ? ToText(values->front()) : "not one number") +
      ": it has to be at least " + ToText(low) +
      (isBounded ? " and at most " + ToText(high) : std::string()) + ".");
    return;
  }
  value = values->front();
}

void InputReader::Read(const char* name, double& value, double low, double high)
{
  this->ReadNumber(name, "a real number", value, low, high);
}

void InputReader::ReadInteger(
  const char* name, std::int64_t& value, std::int64_t low, std::int64_t high)
{
  this->ReadNumber(name, "a whole number", value, low, high);
}

void InputReader::Read(const char* name, std::vector<double>& values)
{
  if (const std::vector<double>* const found = this->Find<double>(name, "real numbers"))
  {
    values = *found;
  }
}

void InputReader::Read(const char* name, std::vector<Id>& values)
{
  const std::vector<std::int64_t>* const found = this->Find<std::int64_t>(name, "whole numbers");
  if (!found)
  {
    return;
  }
  values.resize(found->size());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if ((*found)[i] < std::numeric_limits<Id>::min() ||
      (*found)[i] > std::numeric_limits<Id>::max())
    {
      this->Fail(std::string(name) + " has the value " + ToText((*found)[i]) + " at " +
        std::to_string(i) + ", which 32 bits cannot hold.");
      return;
    }
    values[i] = static_cast<Id>((*found)[i]);
  }
}

void InputReader::ReadIds(const char* name, std::vector<Id>& values, std::size_t number)
{
  this->Read(name, values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (values[i] < 0 || static_cast<std::size_t>(values[i]) >= number)
    {
      this->Fail(std::string(name) + " has the id " + ToText(values[i]) + " at " +
        std::to_string(i) + ": there are " + std::to_string(number) + ".");
      values.clear();
      return;
    }
  }
}

void InputReader::Read(const char* name, std::vector<Vec3>& values)
{
  const std::vector<double>* const found = this->Find<double>(name, "real numbers");
  if (found && this->CheckSize(name, found->size(), 3))
  {
    values.resize(found->size() / 3);
    for (std::size_t i = 0; i < found->size(); ++i)
    {
      values[i / 3][static_cast<int>(i % 3)] = (*found)[i];
    }
  }
}

void InputReader::Read(const char* name, std::vector<RegionPair>& values)
{
  std::vector<Id> ids;
  this->Read(name, ids);
  if (this->CheckSize(name, ids.size(), 2))
  {
    values.resize(ids.size() / 2);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = { ids[2 * i], ids[2 * i + 1] };
    }
  }
}

void InputReader::Read(const char* name, std::vector<char>& values)
{
  std::vector<Id> ids;
  this->ReadIds(name, ids, 2);
  values.assign(ids.begin(), ids.end());
}

void InputReader::Match(const char* name, std::size_t count, std::size_t expected)
{
  if (count != 0 && count != expected)
  {
    this->Fail(std::string(name) + " has " + std::to_string(count) +
      " rows: " + std::to_string(expected) + " are needed.");
  }
}

void InputReader::Fail(std::string message)
{
  if (this->Problem.empty())
  {
    this->Problem = std::move(message);
  }
}

Status InputReader::Finish()
{
  for (const auto& [name, values] : this->Arrays.Inputs)
  {
    if (this->Names.count(name) == 0)
    {
      this->Fail("There is no option " + name + " in this stage.");
    }
  }
  return this->Problem.empty() ? Status()
                               : Status::Failure(StatusCode::InvalidOption, this->Problem);
}

//--------------------------------------------------------------------------------------------------
void OutputWriter::Write(const std::string& name, double value)
{
  this->Write(name, std::vector<double>{ value });
}

void OutputWriter::Write(const std::string& name, std::int64_t value)
{
  this->Write(name, std::vector<Id>{ static_cast<Id>(std::min<std::int64_t>(value, LargestId)) });
}

void OutputWriter::Write(const std::string& name, std::string text)
{
  const auto owner = std::make_shared<const std::string>(std::move(text));
  this->Arrays.Outputs[name] = { owner, owner->data(), cdmText,
    static_cast<std::int64_t>(owner->size()), 1 };
}
} // namespace cdm
