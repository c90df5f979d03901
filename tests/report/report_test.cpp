#include <gtest/gtest.h>

#include <Eigen/Core>
#include <set>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/sample.hpp"
#include "cloud2csg/view.hpp"
#include "paper/objective/objective.hpp"
#include "report/decoded.hpp"
#include "view/report/deviation.hpp"
#include "view/report/gather.hpp"

namespace cloud2csg {
namespace {

Model shipped(const std::string& name) {
  return read_model(std::string(CLOUD2CSG_DATA_DIR) + "/models/" + name);
}

Report report_of(const Model& model, std::size_t points, double noise) {
  Report report{.title = "a cloud", .model = model};
  report.cloud = sample_surface(model, {.count = points, .noise = noise});
  return report;
}

test::Decoded gathered(const Report& report, const ReportOptions& options = {}) {
  return test::decoded(gather_payload(report, options, {}));
}

Points points_of(const test::Decoded& data) {
  const auto& cloud = data.text["cloud"];
  const auto steps = data.numbers<std::uint16_t>(cloud["positions"]);
  Points points;
  for (std::size_t i = 0; i < steps.size(); i += 3) {
    Eigen::Vector3d place;
    for (int axis = 0; axis < 3; ++axis) {
      const double least = cloud["least"][static_cast<std::size_t>(axis)];
      const double greatest = cloud["greatest"][static_cast<std::size_t>(axis)];
      place[axis] = least + steps[i + static_cast<std::size_t>(axis)] / 65535.0 * (greatest - least);
    }
    points.push_back(place);
  }
  return points;
}

std::vector<double> distances_of(const test::Decoded& data) {
  std::vector<double> distances;
  const double unit = data.text["cloud"]["distance_unit"];
  for (const std::uint16_t bits : data.numbers<std::uint16_t>(data.text["cloud"]["distances"])) {
    distances.push_back(unit * static_cast<double>(Eigen::numext::bit_cast<Eigen::half>(bits)));
  }
  return distances;
}

TEST(Report, FiguresAreThoseOfTheFit) {
  const Report report = report_of(shipped("m1.json"), 5000, 0.01);
  const auto all = gathered(report).text["deviation"]["all"];
  const FitStatistics fit = measure_fit(report.model, *report.cloud, 0.01, {}, {});
  EXPECT_EQ(all["points"], 5000);
  EXPECT_DOUBLE_EQ(all["rms"].get<double>(), fit.rms_distance);
  EXPECT_DOUBLE_EQ(all["p95"].get<double>(), fit.p95_distance);
}

TEST(Report, DistancesAreTheSolidsAtTheShownPoints) {
  const Report report = report_of(shipped("m2.json"), 4000, 0.01);
  const test::Decoded data = gathered(report);
  const Points points = points_of(data);
  const std::vector<double> distances = distances_of(data);
  ASSERT_EQ(points.size(), 4000U);
  const std::vector<double> values = implicit_value(*report.model.tree, report.model.primitives, points);
  const auto owners = data.numbers<std::uint16_t>(data.text["cloud"]["owners"]);
  const double step = bounds_of(report.cloud->positions).sizes().maxCoeff() / 65535;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(distances[i], values[i], 2 * step + 1e-3 * std::abs(values[i])) << i;
    ASSERT_GT(owners[i], 0) << i;
    Points one;
    one.push_back(points[i]);
    const double own = signed_distance(report.model.primitives[owners[i] - 1U], one)[0];
    EXPECT_NEAR(std::abs(own), std::abs(values[i]), 4 * step) << i;
  }
}

TEST(Report, MoreThanTheBudgetIsThinnedButAllPointsCount) {
  const Report report = report_of(shipped("m1.json"), 3000, 0.01);
  const test::Decoded data = gathered(report, {.most_points = 500});
  EXPECT_EQ(data.text["cloud"]["points"], 3000);
  EXPECT_EQ(data.text["cloud"]["shown"], 500);
  EXPECT_EQ(points_of(data).size(), 500U);
  EXPECT_EQ(data.text["deviation"]["all"]["points"], 3000);
  // Evenly in space: each half has about half of them.
  const Points points = points_of(data);
  const Eigen::Vector3d middle = bounds_of(points).center();
  for (int axis = 0; axis < 3; ++axis) {
    const auto in_half = [&](const Points& all) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < all.size(); ++i) count += all[i][axis] < middle[axis] ? 1 : 0;
      return static_cast<double>(count) / static_cast<double>(all.size());
    };
    EXPECT_NEAR(in_half(points), in_half(report.cloud->positions), 0.03);
  }
}

TEST(Report, DistancesAreSigned) {
  Model model{.primitives = {{.id = "ball", .shape = Sphere{1.0}}}, .tree = CsgTree::leaf(0)};
  Report report{.model = model, .cloud = PointCloud{}};
  for (const double radius : {0.75, 1.0, 1.5}) report.cloud->positions.push_back({radius, 0, 0});
  const auto deviation = gathered(report).text["deviation"];
  EXPECT_DOUBLE_EQ(deviation["all"]["least"], -0.25);
  EXPECT_DOUBLE_EQ(deviation["all"]["greatest"], 0.5);
  EXPECT_DOUBLE_EQ(deviation["all"]["mean"], 0.25 / 3);
  EXPECT_EQ(deviation["worst"][0]["distance"], 0.5);
  EXPECT_EQ(deviation["by_primitive"].size(), 1U);
  EXPECT_EQ(deviation["by_primitive"][0]["points"], 3);
}

TEST(Report, EveryNodeOfAShippedModelHasAMesh) {
  const Report report{.model = shipped("m0.json")};
  const test::Decoded data = gathered(report);
  const auto& solid = data.text["solid"];
  EXPECT_FALSE(data.text.contains("cloud"));
  std::size_t triangles = 0;
  for (const auto& mesh : solid["meshes"]) {
    ASSERT_GT(mesh["triangles"].get<std::size_t>(), 0U);
    triangles += mesh["triangles"].get<std::size_t>();
    const auto positions = data.numbers<std::uint16_t>(mesh["positions"]);
    for (const std::uint32_t corner : data.numbers<std::uint32_t>(mesh["corners"])) {
      ASSERT_LT(corner, positions.size() / 3);
    }
    EXPECT_EQ(data.numbers<std::uint16_t>(mesh["owners"]).size(), mesh["triangles"].get<std::size_t>());
  }
  for (const auto& node : solid["nodes"]) EXPECT_FALSE(node["mesh"].is_null());
  EXPECT_LE(triangles, ReportOptions{}.most_triangles_in_all);
}

TEST(Report, TheMeshOfTheWholeIsAsLargeAsTheSolid) {
  const Report report{.model = shipped("m1.json")};
  const auto text = gathered(report).text;
  const AlignedBox box = bounds_of(report.model);
  const auto& mesh = text["solid"]["meshes"][text["solid"]["nodes"][0]["mesh"].get<std::size_t>()];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_GE(mesh["least"][axis].get<double>(), box.min()[static_cast<int>(axis)] - 1e-2);
    EXPECT_LE(mesh["greatest"][axis].get<double>(), box.max()[static_cast<int>(axis)] + 1e-2);
  }
}

TEST(Report, BudgetsHold) {
  const Report report{.model = shipped("m0.json")};
  const auto text = gathered(report, {.most_triangles = 500, .most_triangles_in_all = 2000, .most_meshes = 7}).text;
  std::size_t triangles = 0;
  for (const auto& mesh : text["solid"]["meshes"]) triangles += mesh["triangles"].get<std::size_t>();
  EXPECT_LE(text["solid"]["meshes"].size(), 7U);
  EXPECT_LE(triangles, 2000U);
  EXPECT_FALSE(text["solid"]["nodes"][0]["mesh"].is_null());
}

TEST(Report, OverlapsAndPartitionsAreThoseOfTheGraph) {
  const Report report = report_of(shipped("m0.json"), 2000, 0.0);
  const auto overlap = gathered(report).text["overlap"];
  const OverlapGraph graph =
      build_overlap_graph(report.model.primitives, {.tolerance = overlap["tolerance"].get<double>(), .extents = {}});
  EXPECT_EQ(overlap["edges"].size(), graph.edge_count());
  std::set<Clique> given;
  for (const auto& clique : overlap["cliques"]) given.insert(clique.get<Clique>());
  const std::vector<Clique> cliques = maximal_cliques(graph);
  EXPECT_EQ(given, std::set<Clique>(cliques.begin(), cliques.end()));
}

TEST(Report, EmptyUnboundedAndLonelyModelsAreShown) {
  const PrimitiveSet primitives{{.id = "ball", .shape = Sphere{1.0}}, {.id = "ground", .shape = HalfSpace{}}};
  for (const CsgTree& tree : {CsgTree::empty(), CsgTree::full(), CsgTree::leaf(1), complement(CsgTree::leaf(0)),
                              subtract(CsgTree::leaf(0), CsgTree::leaf(0))}) {
    Report report{.model = {.primitives = primitives, .tree = tree}, .cloud = PointCloud{}};
    report.cloud->positions.push_back({1, 0, 0});
    const auto text = gathered(report).text;
    EXPECT_EQ(text["primitives"].size(), 2U);
    EXPECT_EQ(text.contains("deviation"), !is_constant(tree));
  }
}

TEST(Report, AModelWithoutATreeIsRefused) {
  EXPECT_THROW((void)report_page({.model = {.primitives = shipped("m1.json").primitives}}), Error);
}

TEST(Report, OptionsAreChecked) {
  EXPECT_THROW(validate(ReportOptions{.most_points = 0}), Error);
  EXPECT_THROW(validate(ReportOptions{.resolution = 3}), Error);
  EXPECT_THROW(validate(ReportOptions{.most_triangles = 10, .most_triangles_in_all = 9}), Error);
  EXPECT_NO_THROW(validate(ReportOptions{}));
}

class ReportPage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_report_page()) GTEST_SKIP() << "built without Node.js: there is no page";
  }
};

TEST_F(ReportPage, NamesStayWithinTheData) {
  const std::string hostile = "</script><script>alert(1)</script>\"'\n\r`$(reboot)${x}<!--\xFF\xE2\x80\xA8";
  const Model model{
      .primitives = {{.id = hostile, .shape = Sphere{1.0}}}, .tree = CsgTree::leaf(0), .description = hostile};
  Report report{.title = hostile, .source = hostile, .model = model};
  report.parameters = {{hostile, hostile, hostile}};
  report.downloads = {{hostile + ".scad", hostile}};
  report.warnings = {hostile};
  const std::string page = report_page(report);
  const std::string plain = report_page(
      {.title = "x", .model = {.primitives = {{.id = "x", .shape = Sphere{1.0}}}, .tree = CsgTree::leaf(0)}});
  // But for the data, which is base64, the page is the same whatever the names are.
  const auto without_data = [](std::string text) {
    const std::string data = test::data_of_page(text);
    EXPECT_EQ(data.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/="),
              std::string::npos);
    return text.erase(text.find(data), data.size());
  };
  EXPECT_EQ(without_data(page), without_data(plain));
  EXPECT_EQ(page.find("alert(1)"), std::string::npos);
  const test::Decoded data = test::decoded(test::inflated(test::from_base64(test::data_of_page(page))));
  const std::string shown = data.text["title"];
  EXPECT_EQ(shown.substr(0, hostile.find('\xFF')), hostile.substr(0, hostile.find('\xFF')));
  EXPECT_EQ(data.text["primitives"].size(), 1U);
}

TEST_F(ReportPage, IsSmall) {
  const std::string page = report_page(report_of(shipped("m0.json"), 100'000, 0.01));
  EXPECT_LT(page.size(), 3'000'000U);
  EXPECT_EQ(page.substr(0, 15), "<!doctype html>");
}

TEST_F(ReportPage, AsksForNothingFromElsewhere) {
  const std::string page = report_page({.model = shipped("m1.json")});
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  for (const char* link : {"src=\"http", "href=\"http", "src=\"/", "href=\"/", "@import"}) {
    EXPECT_EQ(page.find(link), std::string::npos) << link;
  }
}

TEST_F(ReportPage, IsTheSameForAnyNumberOfThreads) {
  const Report report = report_of(shipped("m2.json"), 3000, 0.01);
  EXPECT_EQ(report_page(report, {}, {.threads = 1}), report_page(report, {}, {.threads = 3}));
}

}  // namespace
}  // namespace cloud2csg
