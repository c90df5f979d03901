#pragma once

/// \file
/// Includes everything that most programs need. cloud2csg/advanced/ has the headers of single stages.

#include "cloud2csg/compare.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/extract.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/run_context.hpp"
#include "cloud2csg/sample.hpp"
#include "cloud2csg/view.hpp"
