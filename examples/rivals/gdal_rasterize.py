#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""GDAL's RasterizeLayer under test.
  surefill certify --command "/usr/bin/python3 examples/rivals/gdal_rasterize.py"            (Debian's package python3-gdal)
"""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "python/surefill"))  # where the package is not installed
import numpy as np
from osgeo import gdal, ogr

from serving import each_triangle, serve

gdal.UseExceptions()
memory = ogr.GetDriverByName("Memory")


@each_triangle
def draw(xy, height, width):
    raster = gdal.GetDriverByName("MEM").Create("", width, height, 1)
    raster.SetGeoTransform((0, 1, 0, 0, 0, 1))
    source = memory.CreateDataSource("")
    layer = source.CreateLayer("", geom_type=ogr.wkbPolygon)
    feature = ogr.Feature(layer.GetLayerDefn())
    ring = ogr.Geometry(ogr.wkbLinearRing)
    for x, y in xy[[0, 1, 2, 0]].tolist():
        ring.AddPoint_2D(x, y)
    polygon = ogr.Geometry(ogr.wkbPolygon)
    polygon.AddGeometry(ring)
    feature.SetGeometry(polygon)
    layer.CreateFeature(feature)
    gdal.RasterizeLayer(raster, [1], layer, burn_values=[1])
    return raster.ReadAsArray()


serve(draw, name="GDAL RasterizeLayer", version=gdal.__version__)
