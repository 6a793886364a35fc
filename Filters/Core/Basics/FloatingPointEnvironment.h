// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FloatingPointEnvironment.h
 * @brief The arithmetic that error bounds count on, whatever the program around has set up.
 *
 * The filters of the predicates, and all that is rounded, assume IEEE arithmetic with rounding to
 * nearest, denormal numbers, and long doubles of full precision. Other libraries of a program change
 * that for the thread that loads them: those built with -ffast-math flush denormal numbers to zero,
 * the Python module of DEVSIM lowers the precision of long doubles to 53 bits. A wrong sign is then a
 * wrong mesh.
 */
#ifndef cdmFloatingPointEnvironment_h
#define cdmFloatingPointEnvironment_h

#include <cfenv>

namespace cdm
{
/** Sets the default environment for its lifetime; threads that begin meanwhile have it, too. */
class FloatingPointEnvironment
{
public:
  FloatingPointEnvironment()
  {
    std::fegetenv(&this->Caller);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatingPointEnvironment() { std::fesetenv(&this->Caller); }
  FloatingPointEnvironment(const FloatingPointEnvironment&) = delete;
  void operator=(const FloatingPointEnvironment&) = delete;

private:
  std::fenv_t Caller{};
};
} // namespace cdm

#endif
