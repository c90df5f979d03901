#include "view/report/payload.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cloud2csg/csg_tree.hpp"
#include "report/decoded.hpp"
#include "view/report/cloud_sections.hpp"
#include "view/report/shown_tree.hpp"

namespace cloud2csg {
namespace {

using Json = Payload::Json;

RC_GTEST_PROP(ReportPayload, NumbersComeBack,
              (const std::vector<std::uint16_t>& shorts, const std::vector<std::uint32_t>& longs)) {
  const std::size_t columns = *rc::gen::inRange<std::size_t>(1, 4);
  const std::vector<std::uint16_t> rows(
      shorts.begin(), shorts.begin() + static_cast<std::ptrdiff_t>(shorts.size() / columns * columns));
  Payload payload;
  const Json first = payload.add_differences(rows, columns);
  const Json second = payload.add_differences(longs, 1);
  const Json third = payload.add_plain(shorts, 1);
  const test::Decoded back = test::decoded(payload.bytes({{"sections", {first, second, third}}}));
  const auto& sections = back.text["sections"];
  RC_ASSERT(back.numbers<std::uint16_t>(sections[0]) == rows);
  RC_ASSERT(back.numbers<std::uint32_t>(sections[1]) == longs);
  RC_ASSERT(back.numbers<std::uint16_t>(sections[2]) == shorts);
}

RC_GTEST_PROP(ReportPayload, BytesComeBackFromText, (const std::string& bytes)) {
  const std::string text = compressed_base64(bytes);
  RC_ASSERT(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=") ==
            std::string::npos);
  RC_ASSERT(test::inflated(test::from_base64(text)) == bytes);
}

TEST(ReportPayload, TextThatIsNoUtf8IsReplaced) {
  const std::string bytes = Payload().bytes({{"name", "a\xFF\x80z"}});
  EXPECT_EQ(test::decoded(bytes).text["name"], "a\uFFFD\uFFFDz");
}

/// As the page does it.
Eigen::Vector3d direction_of(OctahedralNormal stored) {
  double x = stored.u / 255.0 * 2 - 1;
  double y = stored.v / 255.0 * 2 - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double folded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = folded;
  }
  return Eigen::Vector3d(x, y, z).normalized();
}

RC_GTEST_PROP(ReportPayload, NormalsAreOffByADegreeAtMost, ()) {
  const auto component = rc::gen::inRange(-1000, 1001);
  const Eigen::Vector3d direction(*component, *component, *component);
  RC_PRE(direction.norm() > 0);
  const double cosine = direction_of(octahedral(direction.normalized())).dot(direction.normalized());
  RC_ASSERT(cosine > std::cos(0.0175));
}

std::string outline(const CsgTree& tree) {
  std::string text;
  for (const ShownNode& node : shown_tree(tree)) {
    text += std::string(node.depth, ' ') + std::string(to_string(node.operation));
    if (node.operation == Operation::primitive) text += " " + std::to_string(node.primitive);
    text += "\n";
  }
  return text;
}

CsgTree leaf(PrimitiveIndex p) {
  return CsgTree::leaf(p);
}

TEST(ReportTree, ChainsAreOneNode) {
  EXPECT_EQ(outline(leaf(3)), "primitive 3\n");
  EXPECT_EQ(outline(unite(unite(leaf(0), leaf(1)), unite(leaf(2), leaf(3)))),
            "union\n primitive 0\n primitive 1\n primitive 2\n primitive 3\n");
  EXPECT_EQ(outline(subtract(subtract(intersect(leaf(0), leaf(4)), leaf(1)), unite(leaf(2), leaf(3)))),
            "difference\n intersection\n  primitive 0\n  primitive 4\n primitive 1\n primitive 2\n primitive 3\n");
  EXPECT_EQ(outline(complement(unite(leaf(0), subtract(leaf(1), leaf(2))))),
            "complement\n union\n  primitive 0\n  difference\n   primitive 1\n   primitive 2\n");
  EXPECT_EQ(outline(CsgTree::empty()), "empty\n");
}

TEST(ReportTree, ANodeNamesItsOwnSolid) {
  const CsgTree tree = unite(subtract(leaf(0), leaf(1)), intersect(leaf(2), leaf(3)));
  const std::vector<ShownNode> nodes = shown_tree(tree);
  ASSERT_EQ(nodes.size(), 7U);
  EXPECT_EQ(nodes[0].root, tree.root());
  EXPECT_EQ(CsgTree(tree.subtree(nodes[1].root)), subtract(leaf(0), leaf(1)));
  EXPECT_EQ(CsgTree(tree.subtree(nodes[4].root)), intersect(leaf(2), leaf(3)));
  EXPECT_EQ(nodes[0].children, (std::vector<std::size_t>{1, 4}));
  EXPECT_EQ(nodes[5].parent, 4U);
}

}  // namespace
}  // namespace cloud2csg
