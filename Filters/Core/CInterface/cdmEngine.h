/* SPDX-License-Identifier: BSD-3-Clause */
/**
 * @file cdmEngine.h
 * @brief The engine for other languages: named arrays in, named arrays out, no C++ and no VTK.
 *
 * A stage is run by its name, Stages.h lists them with their arrays and options. Arrays come and go
 * in an object that holds any number of them by name. What a stage makes stays in the memory where
 * it made it, until the object is deleted.
 *
 * Guarantees: no exception leaves a function; objects are independent of each other, so that
 * different threads may run stages on different ones.
 * Failure: cdmRun() returns a code other than 0 (StatusCode in Status.h); the output then has the
 * arrays error (text), error_cells and error_points.
 */
#ifndef cdmEngine_h
#define cdmEngine_h

#include <stdint.h>

#if defined(_WIN32)
#define CDM_ENGINE_EXPORT __declspec(dllexport)
#else
#define CDM_ENGINE_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C"
{
#endif

  typedef struct cdmArrays cdmArrays;

  /** What an array consists of. */
  enum cdmType
  {
    cdmReal64 = 0,
    cdmInt32 = 1,
    cdmUInt8 = 2,
    /** UTF-8, without a zero at the end. */
    cdmText = 3
  };

  /** What a running stage calls; each may be null. */
  typedef struct cdmCallbacks
  {
    /** Gets a fraction from 0 to 1 and what is being done; a value other than 0 aborts the stage. */
    int (*Progress)(double fraction, const char* activity, void* data);
    /** The longest edge wanted at a position, in model units; asked from several threads. */
    double (*Sizing)(const double* position, void* data);
    /** Handed to both. */
    void* Data;
    /** 0: one for each processor core. */
    int NumberOfThreads;
  } cdmCallbacks;

  /** Version of the project, "1.0.0". */
  CDM_ENGINE_EXPORT const char* cdmGetVersion(void);

  /** Null: not enough memory. */
  CDM_ENGINE_EXPORT cdmArrays* cdmNewArrays(void);
  CDM_ENGINE_EXPORT void cdmDeleteArrays(cdmArrays* arrays);

  /** Copy an array in; 0, or not enough memory. Integers outside of 32 bits are refused by stages. */
  CDM_ENGINE_EXPORT int cdmSetReals(
    cdmArrays* arrays, const char* name, const double* values, int64_t count);
  CDM_ENGINE_EXPORT int cdmSetIntegers(
    cdmArrays* arrays, const char* name, const int64_t* values, int64_t count);

  CDM_ENGINE_EXPORT int64_t cdmGetNumberOfArrays(const cdmArrays* arrays);
  /** The name of an array, numbered in alphabetical order. It is valid as long as the object. */
  CDM_ENGINE_EXPORT const char* cdmGetName(const cdmArrays* arrays, int64_t index);
  /**
 * The values of an output array, valid as long as the object; null if there are none.
 * @param type one of cdmType
 * @param count number of tuples
 * @param components values of each tuple
 */
  CDM_ENGINE_EXPORT const void* cdmGetValues(
    const cdmArrays* arrays, const char* name, int* type, int64_t* count, int* components);

  /** Runs a stage; the output should be empty. Callbacks may be null. Returns a StatusCode. */
  CDM_ENGINE_EXPORT int cdmRun(
    const char* stage, const cdmArrays* input, cdmArrays* output, const cdmCallbacks* callbacks);

#ifdef __cplusplus
}
#endif

#endif
