// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VolumeSums.h
 * @brief Sums of many volumes that are compared with each other to the last digits.
 */
#ifndef cdmVolumeSums_h
#define cdmVolumeSums_h

#include "Core/Basics/Vec3.h"

#include <cmath>

namespace cdm
{
/**
 * Sum whose error does not grow with the number of terms (A. Neumaier, 1974,
 * doi:10.1002/zamm.19740540106), in extended precision where the machine has it.
 */
class CompensatedSum
{
public:
  void Add(long double term)
  {
    const long double sum = this->Sum + term;
    this->Correction +=
      std::abs(this->Sum) >= std::abs(term) ? (this->Sum - sum) + term : (term - sum) + this->Sum;
    this->Sum = sum;
  }
  void Add(const CompensatedSum& other)
  {
    this->Add(other.Sum);
    this->Add(other.Correction);
  }
  double Get() const { return static_cast<double>(this->Sum + this->Correction); }

private:
  long double Sum = 0.0L;
  long double Correction = 0.0L;
};

/** Six volumes of the tetrahedron (origin, a, b, c), in extended precision. */
inline long double GetSixVolumes(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const long double ax = static_cast<long double>(a.X) - origin.X;
  const long double ay = static_cast<long double>(a.Y) - origin.Y;
  const long double az = static_cast<long double>(a.Z) - origin.Z;
  const long double bx = static_cast<long double>(b.X) - origin.X;
  const long double by = static_cast<long double>(b.Y) - origin.Y;
  const long double bz = static_cast<long double>(b.Z) - origin.Z;
  const long double cx = static_cast<long double>(c.X) - origin.X;
  const long double cy = static_cast<long double>(c.Y) - origin.Y;
  const long double cz = static_cast<long double>(c.Z) - origin.Z;
  return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}
} // namespace cdm

#endif
