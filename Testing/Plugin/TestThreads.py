# SPDX-License-Identifier: BSD-3-Clause
"""All cores work in ParaView as it comes, and as many threads as VTK_SMP_MAX_THREADS says."""

import os

from paraview.simple import *

LoadPlugin(os.environ["CDM_PLUGIN"], remote=False, ns=globals())


def count_threads():
    return len(os.listdir("/proc/self/task"))


# Stages that improve tetrahedra have threads that wait meanwhile: they are left out.
mesher = ConformingDelaunayMesher(
    Input=Box(), MeshFor="Fewest points", RemoveSlivers="No", MaximumEdgeLength=0.05)
counts = []
mesher.GetClientSideObject().AddObserver(
    "ProgressEvent", lambda *_: counts.append(count_threads()))
others = count_threads() - 1
mesher.UpdatePipeline()
assert mesher.GetDataInformation().GetNumberOfCells() > 1000
threads = max(counts) - others
expected = int(os.environ.get("VTK_SMP_MAX_THREADS", os.cpu_count()))
assert threads == expected, "%d threads instead of %d" % (threads, expected)
