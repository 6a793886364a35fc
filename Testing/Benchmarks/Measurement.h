// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Measurement.h
 * @brief Time and memory of work in a process of its own, for the benchmarks.
 *
 * The work makes its input, starts the clock, and stops it when it is done. Several copies can run
 * at the same time: what they lose is lost to the machine, and no number of threads can win it
 * back.
 */
#ifndef Measurement_h
#define Measurement_h

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

inline double GetUserTime()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * usage.ru_utime.tv_usec;
}

/** Memory of this process as Linux counts it, by the name of the line (VmRSS, VmHWM); or 0. */
inline double GetMegabytes(const char* name)
{
  double kilobytes = 0.0;
  if (std::FILE* file = std::fopen("/proc/self/status", "r"))
  {
    char line[256];
    while (std::fgets(line, sizeof(line), file))
    {
      if (std::strncmp(line, name, std::strlen(name)) == 0)
      {
        std::sscanf(line + std::strlen(name), ": %lf", &kilobytes);
      }
    }
    std::fclose(file);
  }
  return kilobytes / 1024.0;
}

struct Measurement
{
  /** User time; negative: the work failed. */
  double Seconds = -1.0;
  /** User and system time, which the kernel cannot tell apart exactly. */
  double ProcessorSeconds = 0.0;
  double WallSeconds = 0.0;
  /** Peak memory of the process from the start of the clock on, and what the work added to it. */
  double Megabytes = 0.0;
  double AddedMegabytes = 0.0;
  /** What the work has made: numbers of points, of tetrahedra, or whatever it counts. */
  std::array<double, 2> Counts{};
};

/** Started by the work when it has its input, stopped when it has what it makes. */
struct Clock
{
  double User = 0.0;
  std::clock_t Processor = 0;
  double Megabytes = 0.0;
  std::chrono::steady_clock::time_point Wall;

  void Start()
  {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    // From here on the peak counts.
    if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w"))
    {
      std::fputs("5", file);
      std::fclose(file);
    }
    this->Megabytes = GetMegabytes("VmRSS");
    this->User = GetUserTime();
    this->Processor = std::clock();
    this->Wall = std::chrono::steady_clock::now();
  }

  void Stop(const std::array<double, 2>& counts)
  {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - this->Wall;
    this->Measured.Seconds = GetUserTime() - this->User;
    this->Measured.ProcessorSeconds =
      static_cast<double>(std::clock() - this->Processor) / CLOCKS_PER_SEC;
    this->Measured.WallSeconds = wall.count();
    this->Measured.Megabytes = GetMegabytes("VmHWM");
    this->Measured.AddedMegabytes = this->Measured.Megabytes - this->Megabytes;
    this->Measured.Counts = counts;
  }

  Measurement Measured;
};

/** Fails if both counts are zero. */
using Work = std::function<void(Clock& clock)>;

/** A measurement under way. */
struct MeasuredProcess
{
  pid_t Process = -1;
  int End = -1;
};

inline MeasuredProcess StartProcess(const Work& work)
{
  int ends[2];
  if (pipe(ends) != 0)
  {
    return {};
  }
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    Clock clock;
    work(clock);
    const Measurement& result = clock.Measured;
    const bool isWritten = write(ends[1], &result, sizeof(result)) == sizeof(result);
    _exit(isWritten ? 0 : 1);
  }
  close(ends[1]);
  return { child, ends[0] };
}

inline Measurement FinishProcess(const MeasuredProcess& process)
{
  Measurement result;
  const bool isRead = read(process.End, &result, sizeof(result)) == sizeof(result);
  close(process.End);
  int status = 0;
  waitpid(process.Process, &status, 0);
  const bool isGood = isRead && WIFEXITED(status) && WEXITSTATUS(status) == 0 &&
    (result.Counts[0] != 0.0 || result.Counts[1] != 0.0);
  return isGood ? result : Measurement();
}

/** Several copies at the same time: the result is that of the slowest. */
inline Measurement Measure(const Work& work, int copies = 1)
{
  std::vector<MeasuredProcess> processes;
  for (int i = 0; i < copies; ++i)
  {
    processes.push_back(StartProcess(work));
  }
  Measurement slowest;
  bool hasFailed = false;
  for (const MeasuredProcess& process : processes)
  {
    const Measurement result = FinishProcess(process);
    hasFailed = hasFailed || result.Seconds < 0.0;
    slowest = result.WallSeconds > slowest.WallSeconds ? result : slowest;
  }
  return hasFailed ? Measurement() : slowest;
}

/** The median of each quantity by itself. */
inline Measurement GetMedian(std::vector<Measurement> results)
{
  const auto middle = results.begin() + static_cast<std::ptrdiff_t>(results.size() / 2);
  Measurement median = results.front();
  for (double Measurement::*quantity : { &Measurement::Seconds, &Measurement::WallSeconds,
         &Measurement::ProcessorSeconds, &Measurement::Megabytes, &Measurement::AddedMegabytes })
  {
    std::nth_element(results.begin(), middle, results.end(),
      [quantity](const Measurement& a, const Measurement& b) { return a.*quantity < b.*quantity; });
    median.*quantity = (*middle).*quantity;
  }
  return median;
}

#endif
