# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads into a pvserver, and a client meshes a cube there.

Starts the server, then itself with the port as argument in pvpython: the client.
"""

import os
import socket
import subprocess
import sys


def RunClient(port):
    from paraview import simple

    simple.Connect("127.0.0.1", port)
    simple.LoadPlugin(os.environ["CDM_PLUGIN"], remote=True, ns=globals())
    mesher = ConformingDelaunayMesher(Input=simple.Box(), MaximumEdgeLength=0.5)
    mesher.UpdatePipeline()
    cells = mesher.GetDataInformation().GetNumberOfCells()
    assert cells > 12, cells
    assert mesher.GetClientSideObject() is None, "the filter runs in the server"
    assert mesher.GetCellDataInformation().GetArray("RegionId") is not None
    print("client and server:", cells, "tetrahedra")


def RunBoth():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    server = subprocess.Popen([os.environ["CDM_PVSERVER"], "--server-port=%d" % port],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        for line in server.stdout:
            print("pvserver:", line.rstrip())
            if line.startswith("Accepting connection"):
                break
        assert server.poll() is None, "pvserver did not start"
        subprocess.run([os.environ["CDM_PVPYTHON"], os.path.abspath(__file__), str(port)],
                       check=True, timeout=200)
        output = server.communicate(timeout=60)[0]
        print(output)
        assert server.returncode == 0, "pvserver ended with %d" % server.returncode
        assert "ERR|" not in output, "pvserver reports an error"
    finally:
        if server.poll() is None:
            server.kill()


if len(sys.argv) > 1:
    RunClient(int(sys.argv[1]))
else:
    RunBoth()
