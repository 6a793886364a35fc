# SPDX-License-Identifier: BSD-3-Clause
"""Boundary-conforming Delaunay tetrahedral meshes: the filters of ConformingDelaunay.

    from conforming_delaunay import vtkConformingDelaunayMesher

Works in pvpython, beside the proxies of paraview.simple, and in any Python that finds the
vtkmodules of the VTK which the package was built with.
"""

from .cdmMeshing import *
