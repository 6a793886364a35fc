# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads into a pvserver, and a client meshes a cube there."""

import os
import socket
import subprocess
import sys

from paraview.simple import *

with socket.socket() as probe:
    probe.bind(("localhost", 0))
    port = probe.getsockname()[1]

server = subprocess.Popen([os.environ["CDM_PVSERVER"], "--server-port=%d" % port],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
try:
    for line in server.stdout:
        print("pvserver:", line.rstrip())
        if line.startswith("Accepting connection"):
            break
    assert server.poll() is None, "pvserver did not start"

    Connect("localhost", port)
    LoadPlugin(os.environ["CDM_PLUGIN"], remote=True, ns=globals())
    mesher = ConformingDelaunayMesher(Input=Box(), MaximumEdgeLength=0.5)
    mesher.UpdatePipeline()
    information = mesher.GetDataInformation()
    cells = information.GetNumberOfCells()
    assert cells > 12, cells
    assert mesher.GetClientSideObject() is None, "the filter runs in the server"
    assert mesher.GetCellDataInformation().GetArray("RegionId") is not None
    print("client and server:", cells, "tetrahedra")
    Disconnect()
    assert server.wait(60) == 0, "pvserver ended with %s" % server.returncode
finally:
    if server.poll() is None:
        server.kill()
sys.stdout.flush()
