// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Texts.h"

#include "CoreBridge/ArrayNames.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <cstring>

namespace
{
constexpr const char* HexDigits = "0123456789ABCDEF";

std::string Encode(const std::string& text)
{
  std::string encoded;
  for (const char character : text)
  {
    const auto code = static_cast<unsigned char>(character);
    if (code < 0x20 || code > 0x7e || std::strchr("\"&'<>%", character))
    {
      encoded += { '%', HexDigits[code / 16], HexDigits[code % 16] };
    }
    else
    {
      encoded += character;
    }
  }
  return encoded;
}

/** What is no code stays as it is. */
std::string Decode(const std::string& encoded)
{
  const auto getDigit = [](char character)
  {
    const char* const found = character == '\0' ? nullptr : std::strchr(HexDigits, character);
    return found ? static_cast<int>(found - HexDigits) : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < encoded.size(); ++i)
  {
    const bool mayBeCode = encoded[i] == '%' && i + 2 < encoded.size();
    const int high = mayBeCode ? getDigit(encoded[i + 1]) : -1;
    const int low = mayBeCode ? getDigit(encoded[i + 2]) : -1;
    const bool isCode = high >= 0 && low >= 0;
    text += isCode ? static_cast<char>(16 * high + low) : encoded[i];
    i += isCode ? 2 : 0;
  }
  return text;
}
} // namespace

namespace vtkCoreBridge
{
//--------------------------------------------------------------------------------------------------
void SetTexts(const char* name, const std::vector<std::string>& texts, vtkFieldData* data)
{
  data->RemoveArray(name);
  if (texts.empty())
  {
    return;
  }
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(texts.size()));
  array->SetNumberOfTuples(1);
  for (int i = 0; i < array->GetNumberOfComponents(); ++i)
  {
    array->SetValue(i, i);
    array->SetComponentName(i, Encode(texts[i]).c_str());
  }
  data->AddArray(array);
}

//--------------------------------------------------------------------------------------------------
std::vector<std::string> GetTexts(const char* name, vtkFieldData* data)
{
  std::vector<std::string> texts;
  vtkAbstractArray* const array = data->GetAbstractArray(name);
  if (auto strings = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < strings->GetNumberOfValues(); ++i)
    {
      texts.push_back(strings->GetValue(i));
    }
  }
  else if (array && array->HasAComponentName())
  {
    for (int i = 0; i < array->GetNumberOfComponents(); ++i)
    {
      const char* const text = array->GetComponentName(i);
      texts.push_back(text ? Decode(text) : "");
    }
  }
  return texts;
}

//--------------------------------------------------------------------------------------------------
void EncodeNames(vtkFieldData* data)
{
  for (const char* const name : { RegionNamesName, ContactNamesName })
  {
    if (vtkStringArray::SafeDownCast(data->GetAbstractArray(name)))
    {
      SetTexts(name, GetTexts(name, data), data);
    }
  }
}
} // namespace vtkCoreBridge
