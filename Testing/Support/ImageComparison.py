# SPDX-License-Identifier: BSD-3-Clause
"""Strict comparison of a rendered image with its baseline.

Counts the pixels that differ by more than 8 of 256 levels in a channel, and fails above 0.05 % of
the image or where the sizes differ. VTK's own comparison forgives shifts and averages, and so does
not see a missing triangle or a slightly smaller body.

    AssertSameAsBaseline("Name.png")    compares $CDM_OUTPUT_DIR/Name.png with
                                        $CDM_DATA_DIR/Baselines/Name.png, or with
                                        $CDM_DATA_DIR/Baselines/VTK9.3/Name.png if there is one and
                                        this is VTK 9.3: it draws some edges otherwise than 9.2
    python3 ImageComparison.py A B      compares two files, exit code 0 or 1
    python3 ImageComparison.py          tests itself
"""

import os
import shutil
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkIOImage import vtkPNGReader

LEVELS = 8
FRACTION = 0.0005


def ReadPixels(path):
    """The image as an array of shape (height, width, 3)."""
    if not os.path.exists(path):
        raise FileNotFoundError(path)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    scalars = vtk_to_numpy(image.GetPointData().GetScalars())
    return scalars.reshape(height, width, -1)[:, :, :3].astype(int)


def CountDifferentPixels(a, b):
    """Pixels of two equally large arrays that differ by more than LEVELS in some channel."""
    return int((numpy.abs(a - b).max(axis=2) > LEVELS).sum())


def FindDifference(imagePath, baselinePath):
    """None if the images are the same to the eye of the test, else a sentence."""
    image = ReadPixels(imagePath)
    baseline = ReadPixels(baselinePath)
    if image.shape != baseline.shape:
        return "size %dx%d instead of %dx%d" % (
            image.shape[1], image.shape[0], baseline.shape[1], baseline.shape[0])
    different = CountDifferentPixels(image, baseline)
    allowed = FRACTION * image.shape[0] * image.shape[1]
    if different > allowed:
        return "%d pixels differ, allowed are %d" % (different, allowed)
    return None


def GetVersionBaseline(name):
    """The path that a baseline of this version of VTK alone has."""
    version = "VTK%d.%d" % (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion())
    return os.path.join(os.environ["CDM_DATA_DIR"], "Baselines", version, name)


def GetCommonBaseline(name):
    """The path of the baseline for all versions that have none of their own."""
    return os.path.join(os.environ["CDM_DATA_DIR"], "Baselines", name)


def GetBaseline(name):
    """The path of the baseline to compare with."""
    path = GetVersionBaseline(name)
    return path if os.path.exists(path) else GetCommonBaseline(name)


def UpdateBaseline(name):
    """The image becomes the baseline; with VTK 9.3 that of this version, where it is not the same."""
    imagePath = os.path.join(os.environ["CDM_OUTPUT_DIR"], name)
    common, own = GetCommonBaseline(name), GetVersionBaseline(name)
    isCommon = vtkVersion.GetVTKMinorVersion() <= 2
    if not isCommon and os.path.exists(common) and FindDifference(imagePath, common) is None:
        if os.path.exists(own):
            os.remove(own)
        print(name, "is as its baseline")
        return
    path = common if isCommon else own
    os.makedirs(os.path.dirname(path), exist_ok=True)
    shutil.copyfile(imagePath, path)
    print("new baseline", path)


def IsBlank(imagePath):
    """True if all pixels have one colour."""
    pixels = ReadPixels(imagePath)
    return CountDifferentPixels(pixels, numpy.broadcast_to(pixels[:1, :1], pixels.shape)) == 0


def AssertSameAsBaseline(name):
    """End the program with exit code 1 unless the image is as its baseline.

    With CDM_UPDATE_BASELINES=1 in the environment the image becomes the baseline.
    """
    imagePath = os.path.join(os.environ["CDM_OUTPUT_DIR"], name)
    if os.environ.get("CDM_UPDATE_BASELINES") == "1":
        UpdateBaseline(name)
        return
    baselinePath = GetBaseline(name)
    try:
        difference = FindDifference(imagePath, baselinePath)
    except FileNotFoundError as missing:
        difference = "no file %s" % missing
    if difference is not None:
        print("%s is not as its baseline %s: %s" % (imagePath, baselinePath, difference))
        sys.exit(1)
    print(name, "is as its baseline")


def TestSelf():
    """The comparison sees what VTK's does not."""
    image = numpy.full((300, 300, 3), 60)
    assert CountDifferentPixels(image, image) == 0
    assert CountDifferentPixels(image, image + LEVELS) == 0
    shifted = image.copy()
    shifted[100:110, 100:110] += LEVELS + 1
    assert CountDifferentPixels(image, shifted) == 100
    assert 100 > FRACTION * 300 * 300
    oneChannel = image.copy()
    oneChannel[5, 5, 2] = 255
    assert CountDifferentPixels(image, oneChannel) == 1
    print("image comparison: ok")


if __name__ == "__main__":
    if len(sys.argv) == 3:
        found = FindDifference(sys.argv[1], sys.argv[2])
        print(found or "same")
        sys.exit(0 if found is None else 1)
    TestSelf()
