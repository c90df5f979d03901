"""From point clouds to editable CSG trees.

>>> import cloud2csg
>>> model = cloud2csg.Model.read("data/models/m0.json")
>>> cloud = cloud2csg.sample(model, count=20_000, noise=0.01)
>>> result = cloud2csg.extract(cloud, model)
>>> cloud2csg.compare(model, result).intersection_over_union > 0.999
True
>>> result.model.to_scad().splitlines()[0]
'$fn = 64;  // facets of a full circle'

Points are NumPy arrays of shape (n, 3), float64, in the cloud's units; angles are in degrees where a name ends in
``_deg``, otherwise in radians. Functions with much work release the interpreter's lock, take ``threads`` (0 = all cores)
and ``progress`` (a callable of stage, done, total), and stop soon with KeyboardInterrupt on Ctrl-C. Bad input raises
cloud2csg.Error; arrays of a wrong shape or with NaN raise ValueError. See docs/python.md.
"""
from cloud2csg._native import (
    Box,
    BrepOptions,
    BrepReport,
    CellSolveOptions,
    CleanOptions,
    CloudWriteOptions,
    CompareOptions,
    Comparison,
    Cone,
    Cylinder,
    DetectedSurface,
    DetectOptions,
    Error,
    ExportOptions,
    ExportReport,
    Expression,
    ExtractOptions,
    Extrusion,
    FailedNode,
    GaOptions,
    HalfSpace,
    InputOptions,
    LabelOptions,
    LocalSearchOptions,
    MeshingOptions,
    MinimalFormulaOptions,
    Model,
    ObjectiveOptions,
    OpenScadOptions,
    PictureOptions,
    PlaceOptions,
    PointCloud,
    Polytope,
    PrepareOptions,
    Primitive,
    ReconstructOptions,
    RefineOptions,
    RegularityOptions,
    ReportOptions,
    Result,
    Revolution,
    SampleCounts,
    SampleOptions,
    ScanOptions,
    ScriptOptions,
    SegmentationOptions,
    SolidOptions,
    Sphere,
    Torus,
    TriangleMesh,
    __version__,
    compare,
    detect,
    extract,
    has_brep,
    has_viewer,
    read_cloud,
    read_mesh,
    sample,
    scan,
)
from cloud2csg.tree import Complement, Difference, Empty, Full, Intersection, Leaf, Node, Union

__all__ = [
    "Box", "BrepOptions", "BrepReport", "CellSolveOptions", "CleanOptions", "CloudWriteOptions",
    "CompareOptions", "Comparison", "Complement", "Cone", "Cylinder", "DetectOptions", "DetectedSurface",
    "Difference", "Empty", "Error", "ExportOptions", "ExportReport", "Expression",
    "ExtractOptions", "Extrusion", "FailedNode", "Full", "GaOptions", "HalfSpace", "InputOptions", "Intersection",
    "LabelOptions", "Leaf", "LocalSearchOptions", "MeshingOptions", "MinimalFormulaOptions", "Model", "Node",
    "ObjectiveOptions", "OpenScadOptions", "PictureOptions", "PlaceOptions", "PointCloud", "Polytope", "PrepareOptions", "Primitive",
    "ReconstructOptions", "RefineOptions", "RegularityOptions", "ReportOptions", "Result", "Revolution", "SampleCounts",
    "SampleOptions", "ScanOptions", "ScriptOptions", "SegmentationOptions", "SolidOptions", "Sphere", "Torus",
    "TriangleMesh", "Union", "__version__", "compare", "detect", "extract", "has_brep", "has_viewer", "read_cloud", "read_mesh",
    "sample", "scan",
]
