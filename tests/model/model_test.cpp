#include "cloud2csg/model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "cloud2csg/error.hpp"
#include "support/any_solid.hpp"
#include "support/structurally_equal.hpp"

namespace cloud2csg {
namespace {

std::string with_primitives(const std::string& primitives, const std::string& tree = "") {
  return R"({"format": "cloud2csg", "version": 1, "primitives": [)" + primitives + "]" +
         (tree.empty() ? "" : ", \"tree\": " + tree) + "}";
}

const std::string k_two_spheres =
    R"({"id": "a", "type": "sphere", "radius": 1}, {"id": "b", "type": "sphere", "radius": 2})";

std::string with_tree(const std::string& tree) {
  return with_primitives(k_two_spheres, tree);
}

Error::Parts refusal(const std::string& text) {
  try {
    (void)parse_model(text, "m.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, "m.json");
    return error.parts();
  }
  ADD_FAILURE() << "accepted: " << text;
  return {};
}

TEST(ReadModel, ReadsEveryType) {
  const Model model = parse_model(with_primitives(R"(
    {"id": "box", "type": "box", "pose": {"position": [1, 2, 3], "quaternion": [0, 1, 0, 0]}, "size": [1, 2, 3]},
    {"id": "sphere", "type": "sphere", "pose": {"position": [1, 2, 3]}, "radius": 0.5},
    {"id": "cylinder", "type": "cylinder", "radius": 1, "height": 2},
    {"id": "cone", "type": "cone", "radius_bottom": 1, "radius_top": 0, "height": 2},
    {"id": "torus", "type": "torus", "major_radius": 1, "minor_radius": 0.25},
    {"id": "half_space", "type": "half_space"},
    {"id": "polytope", "type": "polytope",
     "planes": [[-1, 0, 0, 1], [0, -1, 0, 1], [0, 0, -1, 1], [0.6, 0.8, 0, 1], [0, 0, 1, 2]]},
    {"id": "expression", "type": "expression", "distance": "x^2 + y^2 + z^2 - 1",
     "bounds": [[-1, -1, -1], [1, 1, 1.5]], "displacement": {"frequency": 3},
     "evidence": {"points": 1234, "rms": 0.0012}})"));
  ASSERT_EQ(model.primitives.size(), 8U);
  for (const Primitive& primitive : model.primitives) EXPECT_EQ(primitive.id, type_name(primitive.shape));
  EXPECT_EQ(model.primitives[0].pose.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(model.primitives[0].pose.orientation.x(), 1);
  EXPECT_EQ(std::get<Box>(model.primitives[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<Cone>(model.primitives[3].shape).radius_bottom, 1);
  EXPECT_EQ(std::get<Torus>(model.primitives[4].shape).minor_radius, 0.25);
  EXPECT_EQ(std::get<Polytope>(model.primitives[6].shape).planes[3].normal, Eigen::Vector3d(0.6, 0.8, 0));
  EXPECT_EQ(std::get<Polytope>(model.primitives[6].shape).planes[4].offset, 2);
  EXPECT_EQ(std::get<Expression>(model.primitives[7].shape).bounds.max().z(), 1.5);
  EXPECT_EQ(model.primitives[7].displacement.value().frequency, 3);
  EXPECT_FALSE(model.primitives[6].evidence.has_value());
  EXPECT_EQ(model.primitives[7].evidence.value().points, 1234U);
  EXPECT_EQ(model.primitives[7].evidence.value().rms, 0.0012);
  EXPECT_FALSE(model.tree.has_value());
}

TEST(ReadModel, ReadsNaryTreesFromTheLeft) {
  const Model model = parse_model(with_tree(
      R"({"op": "difference", "children": [{"op": "union", "children": [{"primitive": "a"}, {"primitive": "b"},
          {"op": "complement", "children": [{"op": "full"}]}]},
          {"op": "intersection", "children": [{"primitive": "b"}, {"op": "empty"}]}]})"));
  EXPECT_EQ(to_text(model.tree.value(), model.primitives),
            to_text(parse_tree("((a | b) | ~full) - (b & empty)", model.primitives), model.primitives));
}

struct Refused {
  const char* name;
  std::string text;
  const char* where;
  const char* expected;  ///< a part of the message
};

std::string name_of(const testing::TestParamInfo<Refused>& refused) {
  return refused.param.name;
}

void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.name;
}  // NOLINT: GoogleTest's name

class Refusal : public testing::TestWithParam<Refused> {};

TEST_P(Refusal, NamesTheFieldAndWhatIsExpected) {
  const Error::Parts parts = refusal(GetParam().text);
  EXPECT_EQ(parts.where, GetParam().where);
  EXPECT_NE((parts.expected + "; " + parts.remedy).find(GetParam().expected), std::string::npos)
      << "message: " << parts.expected << "; " << parts.remedy;
}

std::string sphere(const std::string& fields) {
  return with_primitives(R"({"id": "s", "type": "sphere", )" + fields + "}");
}

INSTANTIATE_TEST_SUITE_P(
    Json, Refusal,
    testing::Values(
        Refused{"Syntax", "{\"format\": \"cloud2csg\",\n \"version\": }", "line 2, column 13", "unexpected '}'"},
        Refused{"Empty", "", "line 1, column 1", "unexpected end of input"},
        Refused{"TwiceTheSameField", R"({"format": "cloud2csg", "format": "cloud2csg"})", "/format", "once"},
        Refused{"TwiceInAPrimitive", sphere(R"("radius": 1, "radius": 2)"), "/primitives/0/radius", "once"},
        Refused{"TooLarge", sphere("\"radius\": 1e999"), "/primitives/0/radius",
                "a number that fits a double, found 1e999"},
        Refused{"TooLargeInAList", with_primitives(R"({"id": "a", "type": "half_space"},
                                                     {"id": "b", "type": "half_space", "pose": {"position":
                                                      [0, -1e400, 0]}})"),
                "/primitives/1/pose/position/1", "found -1e400"},
        Refused{"Literal", sphere("\"radius\": NaN"), "line 1, column 94", "invalid literal"},
        Refused{"BrokenText", "{\"format\": \"\xff\xfe\"}", "line 1, column 13", "ill-formed UTF-8"},
        Refused{"OtherEncoding", "\xff\xfe{", "line 1, column 1", "invalid literal"},
        Refused{"MoreAfterTheEnd", with_primitives("") + "\n}", "line 2, column 1", "expected end of input"},
        Refused{"ZeroByteAfterTheEnd", with_primitives("") + std::string(2, '\0'), "line 1, column 56", "value 0"},
        Refused{"HugeVersion", R"({"format": "cloud2csg", "version": 18446744073709551615})", "/version",
                "found 18446744073709551615"},
        Refused{"BottomlessList", R"({"format": )" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}",
                "/format", "too deep"}),
    name_of);

TEST(ReadModel, MessagesAreTheProjectsOwnAndText) {
  for (const std::string& text :
       {std::string("{"), std::string("\xff\xfe"), sphere("\"radius\": 1e999"), sphere("\"radius\": NaN"),
        std::string("{\"format\": \"\xff\"}"), std::string("[\"\x01\"]"), std::string("{} x")}) {
    const Error::Parts parts = refusal(text);
    const std::string message = parts.where + parts.expected + parts.remedy;
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
    EXPECT_EQ(message.find("parse error"), std::string::npos) << message;
    EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; })) << message;
    EXPECT_FALSE(parts.remedy.empty()) << message;
  }
}

TEST(ReadModel, TakesAByteOrderMark) {
  EXPECT_EQ(parse_model("\xef\xbb\xbf" + with_primitives(k_two_spheres)).primitives.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(
    Head, Refusal,
    testing::Values(
        Refused{"NotAnObject", "[1, 2]", "", "expected a model, found a list of 2"},
        Refused{"NoFormat", R"({"version": 1, "primitives": []})", "/format", "expected \"cloud2csg\", found nothing"},
        Refused{"OtherVersion", R"({"format": "cloud2csg", "version": 2, "primitives": []})", "/version", "found 2"},
        Refused{"UnknownField", R"({"format": "cloud2csg", "version": 1, "primitive": []})", "/primitive",
                "a model has the fields description, format, primitives, tree, version"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Primitives, Refusal,
    testing::Values(
        Refused{"Negative", sphere("\"radius\": -1"), "/primitives/0/radius", "expected a number > 0, found -1"},
        Refused{"Text", sphere("\"radius\": \"1\""), "/primitives/0/radius", "expected a number > 0, found \"1\""},
        Refused{"Missing", sphere("\"pose\": {}"), "/primitives/0/radius", "expected a number > 0, found nothing"},
        Refused{"Misspelt", sphere("\"raduis\": 1"), "/primitives/0/raduis", "unknown field"},
        Refused{"FieldOfAnotherType", sphere("\"radius\": 1, \"height\": 2"), "/primitives/0/height", "a sphere has"},
        Refused{"UnknownType", with_primitives(R"({"id": "s", "type": "ball", "radius": 1})"), "/primitives/0/type",
                "box, sphere, cylinder, cone, torus, half_space, polytope, extrusion, revolution, expression, "
                "found \"ball\""},
        Refused{"NoType", with_primitives(R"({"id": "s", "radius": 1})"), "/primitives/0/type", "found nothing"},
        Refused{"NotAnObject", with_primitives("7"), "/primitives/0", "expected a primitive, found 7"},
        Refused{"ShortVector", sphere(R"("radius": 1, "pose": {"position": [1, 2]})"), "/primitives/0/pose/position",
                "expected three numbers [x, y, z], found a list of 2"},
        Refused{"TextInVector", sphere(R"("radius": 1, "pose": {"position": [1, null, 2]})"),
                "/primitives/0/pose/position/1", "expected a number, found null"},
        Refused{"UnknownInPose", sphere(R"("radius": 1, "pose": {"centre": [1, 2, 3]})"), "/primitives/0/pose/centre",
                "a pose has the fields position, quaternion"},
        Refused{"LongQuaternion", sphere(R"("radius": 1, "pose": {"quaternion": [1, 1, 0, 0]})"),
                "/primitives/0/pose/quaternion", "expected unit length, found a length of 1.41421356"},
        Refused{"NegativePoints", sphere(R"("radius": 1, "evidence": {"points": -1, "rms": 0})"),
                "/primitives/0/evidence/points", "a whole number >= 0"},
        Refused{"PartOfAPoint", sphere(R"("radius": 1, "evidence": {"points": 1.5, "rms": 0})"),
                "/primitives/0/evidence/points", "a whole number >= 0"},
        Refused{"EvidenceWithoutRms", sphere(R"("radius": 1, "evidence": {"points": 1})"), "/primitives/0/evidence/rms",
                "a number >= 0, found nothing"},
        Refused{"UnknownInEvidence", sphere(R"("radius": 1, "evidence": {"points": 1, "rms": 0, "mean": 0})"),
                "/primitives/0/evidence/mean", "fields points, rms"},
        Refused{"EmptyId", with_primitives(R"({"id": "", "type": "half_space"})"), "/primitives/0/id",
                "at least one character"},
        Refused{"SameIdTwice",
                with_primitives(R"({"id": "h", "type": "half_space"}, {"id": "h", "type": "half_space"})"),
                "/primitives/1/id", "\"h\" as in /primitives/0"},
        Refused{"LongNormal", with_primitives(R"({"id": "p", "type": "polytope",
                                    "planes": [[1, 0, 0, 1], [-2, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1]]})"),
                "/primitives/0/planes/1", "expected unit length"},
        Refused{"UnboundedPolytope", with_primitives(R"({"id": "p", "type": "polytope",
                                    "planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1]]})"),
                "/primitives/0/planes", "bounded"},
        Refused{"SpindleTorus",
                with_primitives(R"({"id": "t", "type": "torus", "major_radius": 1, "minor_radius": 2})"),
                "/primitives/0/minor_radius", "expected at most the major radius"},
        Refused{"CornerOfOneNumber",
                with_primitives(R"({"id": "e", "type": "extrusion", "height": 1, "profile": [[[0, 0], [1], [0, 1]]]})"),
                "/primitives/0/profile/0/1", "two numbers [x, y]"},
        Refused{"CrossingPath", with_primitives(R"({"id": "e", "type": "extrusion", "height": 1,
                                    "profile": [[[0, 0], [1, 1], [1, 0], [0, 1]]]})"),
                "/primitives/0/profile/0/2", "expected a segment that does not cross or touch segment 0 of path 0"},
        Refused{"ProfileBeyondTheAxis",
                with_primitives(R"({"id": "r", "type": "revolution", "profile": [[[-1, 0], [1, 0], [1, 1]]]})"),
                "/primitives/0/profile/0/0", "expected radii of 0 or more"},
        Refused{"BadFormula", with_primitives(R"({"id": "e", "type": "expression", "distance": "x +* y",
                                    "bounds": [[0, 0, 0], [1, 1, 1]]})"),
                "/primitives/0/distance", "expected a formula in x, y and z"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Tree, Refusal,
    testing::Values(Refused{"UnknownPrimitive",
                            with_tree(R"({"op": "union", "children": [{"primitive": "a"}, {"primitive": "c"}]})"),
                            "/tree/children/1/primitive", "found \"c\""},
                    Refused{"UnknownOperation",
                            with_tree(R"({"op": "unite", "children": [{"primitive": "a"}, {"primitive": "b"}]})"),
                            "/tree/op", "found \"unite\""},
                    Refused{"UnionOfOne", with_tree(R"({"op": "union", "children": [{"primitive": "a"}]})"),
                            "/tree/children", "expected a list of two or more nodes, found a list of 1"},
                    Refused{"DifferenceOfThree",
                            with_tree(R"({"op": "union", "children": [{"primitive": "a"}, {"op": "difference",
                             "children": [{"primitive": "a"}, {"primitive": "a"}, {"primitive": "a"}]}]})"),
                            "/tree/children/1/children", "expected a list of two nodes"},
                    Refused{"NoChildren", with_tree(R"({"op": "complement"})"), "/tree/children", "found nothing"},
                    Refused{"ChildrenOfAConstant", with_tree(R"({"op": "empty", "children": []})"), "/tree/children",
                            "unknown field"},
                    Refused{"Neither", with_tree("{}"), "/tree", "\"primitive\" or \"op\""},
                    Refused{"NotAnObject", with_tree("\"a\""), "/tree", "found \"a\""}),
    name_of);

std::string nested_complements(int levels) {
  std::string text;
  for (int i = 0; i < levels; ++i) text += R"({"op": "complement", "children": [)";
  text += R"({"primitive": "a"})";
  for (int i = 0; i < levels; ++i) text += "]}";
  return text;
}

TEST(ReadModel, DeepTreesPassAndBottomlessOnesAreRefused) {
  const Model model = parse_model(with_tree(nested_complements(9'990)));
  EXPECT_EQ(model.tree.value().size(), 9'991U);
  EXPECT_EQ(parse_model(to_json(model)).tree, model.tree);
  EXPECT_NE(refusal(with_tree(nested_complements(50'000))).expected.find("10000 levels"), std::string::npos);
}

TEST(ReadModel, BringsNearlyUnitQuaternionsToUnitLength) {
  const Model model = parse_model(sphere(R"("radius": 1, "pose": {"quaternion": [0.7071068, 0.7071068, 0, 0]})"));
  EXPECT_NEAR(model.primitives[0].pose.orientation.norm(), 1.0, 1e-15);
}

TEST(ReadModel, NamesAFileThatIsNotThere) {
  EXPECT_THROW(
      {
        try {
          (void)read_model("no/such/model.json");
        } catch (const Error& error) {
          EXPECT_EQ(error.parts().file, "no/such/model.json");
          throw;
        }
      },
      Error);
}

TEST(WriteModel, WritesChainsAsOneNode) {
  Model model = parse_model(with_primitives(k_two_spheres));
  model.tree = parse_tree("((a | b) | (a | b)) - (a & b & a)", model.primitives);
  const std::string text = to_json(model);
  EXPECT_NE(text.find(R"("tree": {"op": "difference", "children": [
  {"op": "union", "children": [
    {"primitive": "a"},
    {"primitive": "b"},
    {"primitive": "a"},
    {"primitive": "b"}]},
  {"op": "intersection", "children": [
    {"primitive": "a"},
    {"primitive": "b"},
    {"primitive": "a"}]}]}})"),
            std::string::npos)
      << text;
}

TEST(WriteModel, RefusesWhatCouldNotBeReadAgain) {
  const Model model{.primitives = {{.id = "s", .shape = Sphere{.radius = -1}}}};
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "cloud2csg_model_test_invalid.json";
  EXPECT_THROW(write_model(file, model), Error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

Primitive any_primitive(std::size_t index) {
  std::string id = *rc::gen::arbitrary<std::string>() + std::to_string(index);
  for (char& c : id) c = static_cast<char>(std::max(c & 0x7f, 1));  // text without NUL
  Primitive primitive{.id = id, .shape = test::any_shape(), .pose = test::any_pose(100)};
  if (*rc::gen::arbitrary<bool>()) primitive.displacement = Displacement{.frequency = test::any_double(1, 9)};
  if (*rc::gen::arbitrary<bool>()) {
    primitive.evidence = Evidence{.points = *rc::gen::arbitrary<std::uint32_t>(), .rms = test::any_double(0, 9)};
  }
  return primitive;
}

CsgTree any_tree(std::size_t primitives) {
  CsgTree tree = CsgTree::leaf(0);
  const int steps = *rc::gen::inRange(0, 12);
  for (int i = 0; i < steps; ++i) {
    const CsgTree leaf = CsgTree::leaf(*rc::gen::inRange<PrimitiveIndex>(0, static_cast<PrimitiveIndex>(primitives)));
    switch (*rc::gen::inRange(0, 6)) {
      case 0:
        tree = unite(tree, leaf);
        break;
      case 1:
        tree = intersect(leaf, tree);
        break;
      case 2:
        tree = subtract(leaf, tree);
        break;
      case 3:
        tree = complement(tree);
        break;
      case 4:
        tree = unite(tree, CsgTree::empty());
        break;
      default:
        tree = intersect(tree, CsgTree::full());
    }
  }
  return tree;
}

RC_GTEST_PROP(WriteModel, ReadsBackToTheLastBit, ()) {
  Model model;
  const auto count = *rc::gen::inRange<std::size_t>(1, 5);
  for (std::size_t i = 0; i < count; ++i) model.primitives.push_back(any_primitive(i));
  model.tree = any_tree(count);
  model.description = "quotes \" and\nlines \t \xc3\xa9";
  const std::string text = to_json(model);
  const Model again = parse_model(text);
  RC_ASSERT(to_json(again) == text);
  RC_ASSERT(again.description == model.description);
  RC_ASSERT(test::structurally_equal(*again.tree, *model.tree));
  for (std::size_t i = 0; i < count; ++i) {
    RC_ASSERT(again.primitives[i].id == model.primitives[i].id);
    RC_ASSERT(again.primitives[i].shape.index() == model.primitives[i].shape.index());
    RC_ASSERT(again.primitives[i].pose.position == model.primitives[i].pose.position);
    RC_ASSERT(again.primitives[i].evidence.has_value() == model.primitives[i].evidence.has_value());
    if (!model.primitives[i].evidence) continue;
    RC_ASSERT(again.primitives[i].evidence->points == model.primitives[i].evidence->points);
    RC_ASSERT(again.primitives[i].evidence->rms == model.primitives[i].evidence->rms);
  }
}

TEST(ReadModel, ReadsALongListOfChildren) {
  constexpr std::size_t k_children = 200'000;
  std::string children = R"({"primitive": "a"})";
  for (std::size_t i = 1; i < k_children; ++i) children += R"(, {"primitive": "b"})";
  const Model model = parse_model(with_tree(R"({"op": "union", "children": [)" + children + "]}"));
  EXPECT_EQ(leaf_count(*model.tree), k_children);
  EXPECT_EQ(refusal(with_tree(R"({"op": "union", "children": [)" + children + ", {}]}")).where,
            "/tree/children/200000");
}

RC_GTEST_PROP(ReadModel, DamagedTextNeverCrashes, ()) {
  std::string text = with_tree(R"({"op": "union", "children": [{"primitive": "a"}, {"primitive": "b"}]})");
  const auto damages = *rc::gen::inRange(1, 4);
  for (int i = 0; i < damages; ++i) {
    text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
  }
  try {
    (void)parse_model(text);
  } catch (const Error& error) {
    RC_ASSERT(std::string(error.what()).find('\n') == std::string::npos);
  }
}

class Data : public testing::TestWithParam<const char*> {};

TEST_P(Data, IsReadAndWritten) {
  const Model model = read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / GetParam());
  ASSERT_TRUE(model.tree.has_value());
  EXPECT_EQ(primitives_of(*model.tree).size(), model.primitives.size());
  EXPECT_FALSE(model.description.empty());
  const std::filesystem::path copy =
      std::filesystem::path(testing::TempDir()) / (std::string("cloud2csg_") + GetParam());
  write_model(copy, model);
  EXPECT_EQ(read_model(copy).tree, model.tree);
  std::filesystem::remove(copy);
}

INSTANTIATE_TEST_SUITE_P(Models, Data, testing::Values("m0.json", "m1.json", "m2.json", "m3.json"));

TEST(Schema, IsTheOneThatIsShipped) {
  EXPECT_NE(model_schema().find("draft-07"), std::string_view::npos);
}

}  // namespace
}  // namespace cloud2csg
