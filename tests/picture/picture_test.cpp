#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

Model ball(double radius = 1) {
  return {.primitives = {{.id = "ball", .shape = Sphere{.radius = radius}}}, .tree = CsgTree::leaf(0)};
}

Colour pixel(const Image& image, int column, int row) {
  const auto place = static_cast<std::size_t>(3 * (row * image.width + column));
  return {.red = image.rgb[place], .green = image.rgb[place + 1], .blue = image.rgb[place + 2]};
}

/// Of columns begin to end.
double share_drawn(const Image& image, const PictureOptions& options, int begin, int end) {
  int drawn = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = begin; column < end; ++column) {
      drawn += pixel(image, column, row) == background(options, row) ? 0 : 1;
    }
  }
  return static_cast<double>(drawn) / (static_cast<double>(end - begin) * image.height);
}

PointCloud points_on_ball() {
  PointCloud cloud;
  for (int i = 0; i < 20'000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 20'000;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Eigen::Vector3d place(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
    cloud.positions.push_back(place);
    cloud.normals.push_back(place);
  }
  return cloud;
}

TEST(Picture, ABallIsADisc) {
  const PictureOptions options{.height = 150};
  const Image image = draw_picture({.model = ball()}, options);
  EXPECT_EQ(image.width, 150);
  EXPECT_EQ(image.height, 150);
  // The ball's box, as it is seen from this side, is as wide as the picture but for the margin.
  const double azimuth = options.azimuth_deg * std::numbers::pi / 180;
  const double elevation = options.elevation_deg * std::numbers::pi / 180;
  const double across = std::abs(std::cos(azimuth)) + std::abs(std::sin(azimuth));
  const double wide = 2 * 1.08 * std::max(across, std::sin(elevation) * across + std::cos(elevation));
  EXPECT_NEAR(share_drawn(image, options, 0, 150), std::numbers::pi / (wide * wide), 0.02);
}

TEST(Picture, ABoxSeenFromAboveIsItsFace) {
  const Model model{.primitives = {{.id = "box", .shape = Box{.size = {2, 1, 1}}}}, .tree = CsgTree::leaf(0)};
  const PictureOptions options{.width = 216, .height = 108, .azimuth_deg = -90, .elevation_deg = 90};
  const Image image = draw_picture({.model = model}, options);
  EXPECT_NEAR(share_drawn(image, options, 0, 216), 1 / (1.08 * 1.08), 0.02);
  const Colour middle = pixel(image, 108, 54);
  EXPECT_EQ(middle, pixel(image, 70, 40)) << "one face, one colour";
  EXPECT_FALSE(middle == background(options, 54));
}

TEST(Picture, HolesAndPrimitivesShow) {
  Model model{.primitives = {{.id = "plate", .shape = Box{.size = {2, 2, 0.5}}},
                             {.id = "bore", .shape = Cylinder{.radius = 0.5, .height = 1}},
                             {.id = "left", .shape = Sphere{.radius = 0.2}, .pose = {.position = {-0.75, 0, 0.25}}}},
              .tree = unite(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2))};
  const PictureOptions options{.height = 100, .azimuth_deg = -90, .elevation_deg = 90};
  const Image image = draw_picture({.model = model}, options);
  EXPECT_EQ(pixel(image, 50, 50), background(options, 50)) << "through the bore";
  EXPECT_FALSE(pixel(image, 85, 50) == background(options, 50));
  const Colour ball_colour = pixel(image, 15, 50);
  const Colour plate_colour = pixel(image, 85, 50);
  EXPECT_GT(std::abs(ball_colour.red - plate_colour.red) + std::abs(ball_colour.green - plate_colour.green) +
                std::abs(ball_colour.blue - plate_colour.blue),
            60);
}

TEST(Picture, CloudAndSolidAreSideBySideInOneView) {
  const PictureOptions options{.height = 120};
  const Image image = draw_picture({.model = ball(), .cloud = points_on_ball()}, options);
  EXPECT_EQ(image.width, 240);
  const double of_cloud = share_drawn(image, options, 0, 120);
  const double of_solid = share_drawn(image, options, 120, 240);
  EXPECT_NEAR(of_cloud, of_solid, 0.03);
  EXPECT_GT(of_solid, 0.2);
  const Image cloud_alone = draw_picture({.cloud = points_on_ball()}, options);
  EXPECT_EQ(cloud_alone.width, 120);
}

TEST(Picture, PointsHaveTheirColours) {
  const PointCloud cloud = points_on_ball();
  const PictureOptions options{.height = 100};
  const Image red = draw_picture({.cloud = cloud, .colours = std::vector<Colour>(cloud.size(), {200, 0, 0})}, options);
  const Colour middle = pixel(red, 50, 50);
  EXPECT_GT(middle.red, middle.green + 40);
}

TEST(Picture, AFewOutliersDoNotShrinkTheRest) {
  PointCloud cloud = points_on_ball();
  const double before = share_drawn(draw_picture({.cloud = cloud}, {.height = 100}), {.height = 100}, 0, 100);
  cloud.positions.push_back({100, 0, 0});
  cloud.normals.push_back({1, 0, 0});
  EXPECT_NEAR(share_drawn(draw_picture({.cloud = cloud}, {.height = 100}), {.height = 100}, 0, 100), before, 0.05);
}

TEST(Picture, DoesNotDependOnTheThreads) {
  const Scene scene{.model = ball(), .cloud = points_on_ball()};
  const Image one = draw_picture(scene, {.height = 90}, {.threads = 1});
  for (const int threads : {2, 3, 0}) EXPECT_EQ(draw_picture(scene, {.height = 90}, {.threads = threads}).rgb, one.rgb);
}

TEST(Picture, ThePngHoldsThePixels) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "cloud2csg_picture_test.png";
  const PictureOptions options{.width = 90, .height = 64};
  write_picture(file, {.model = ball()}, options);
  const std::string bytes = read_text_file(file);
  std::filesystem::remove(file);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  EXPECT_EQ(header.width, 90U);
  EXPECT_EQ(header.height, 64U);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr), 0) << header.message;
  EXPECT_EQ(rgb, draw_picture({.model = ball()}, options).rgb);
}

TEST(Picture, DrawsWhatHasNoBoundsAsItIsCut) {
  const Model model{.primitives = {{.id = "ground", .shape = HalfSpace{}}}, .tree = CsgTree::leaf(0)};
  EXPECT_GT(share_drawn(draw_picture({.model = model}, {.height = 60}), {.height = 60}, 0, 60), 0.1);
}

TEST(Picture, RefusesWhatCannotBeDrawn) {
  const auto message = [](const Scene& scene, const PictureOptions& options) -> std::string {
    try {
      (void)draw_picture(scene, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "drawn";
  };
  EXPECT_NE(message({}, {}).find("a cloud or a solid"), std::string::npos);
  EXPECT_NE(message({.model = ball()}, {.width = 3}).find("width: expected 0, or a whole number from 16 to"),
            std::string::npos);
  EXPECT_NE(message({.model = ball()}, {.width = 4000, .height = 2000}).find("at most 1000 pixels"), std::string::npos);
  EXPECT_NE(message({.model = ball()}, {.height = 0}).find("height"), std::string::npos);
  EXPECT_NE(message({.model = ball()}, {.elevation_deg = 91}).find("elevation_deg"), std::string::npos);
  EXPECT_NE(message({.model = {.primitives = {}, .tree = CsgTree::empty()}}, {}).find("found neither"),
            std::string::npos);
}

}  // namespace
}  // namespace cloud2csg
