// SPDX-License-Identifier: BSD-3-Clause
#include "CoreBridge/Texts.h"

#include "CoreBridge/ArrayNames.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cstring>
#include <utility>

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

/** Cuts an encoded text: pieces end behind a space if there is one, and never within a code. */
std::vector<std::string> Split(const std::string& encoded)
{
  // A piece gets up to three times as long, as VTK's legacy files encode it again.
  constexpr std::size_t longest = 80;
  std::vector<std::string> pieces;
  std::size_t begin = 0;
  while (encoded.size() - begin > longest)
  {
    const std::size_t space = encoded.rfind(' ', begin + longest - 1);
    std::size_t end = begin + longest;
    if (space != std::string::npos && space > begin)
    {
      end = space + 1;
    }
    else if (const std::size_t code = encoded.find('%', end - 2); code < end)
    {
      end = code;
    }
    pieces.push_back(encoded.substr(begin, end - begin));
    begin = end;
  }
  pieces.push_back(encoded.substr(begin));
  return pieces;
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
  std::vector<std::pair<int, std::string>> pieces;
  for (std::size_t i = 0; i < texts.size(); ++i)
  {
    for (const std::string& piece : Split(Encode(texts[i])))
    {
      pieces.emplace_back(static_cast<int>(i), piece);
    }
  }
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(pieces.size()));
  array->SetNumberOfTuples(1);
  for (int i = 0; i < array->GetNumberOfComponents(); ++i)
  {
    array->SetValue(i, pieces[i].first);
    array->SetComponentName(i, pieces[i].second.c_str());
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
  else if (auto numbers = vtkDataArray::SafeDownCast(array);
           numbers && numbers->HasAComponentName() && numbers->GetNumberOfTuples() == 1)
  {
    const int count = numbers->GetNumberOfComponents();
    for (int i = 0; i < count; ++i)
    {
      // No list has more texts than components: other arrays are none.
      const double index = numbers->GetComponent(0, i);
      if (index >= 0.0 && index < count)
      {
        texts.resize(std::max(texts.size(), static_cast<std::size_t>(index) + 1));
        const char* const piece = numbers->GetComponentName(i);
        texts[static_cast<std::size_t>(index)] += piece ? Decode(piece) : "";
      }
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
