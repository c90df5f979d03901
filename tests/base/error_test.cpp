#include "cloud2csg/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cloud2csg {
namespace {

TEST(Error, MessageJoinsAllParts) {
  const Error error({.file = "a.ply", .where = "line 3", .expected = "expected a number", .remedy = "fix it"});
  EXPECT_STREQ(error.what(), "a.ply: line 3: expected a number; fix it");
}

TEST(Error, EmptyPartsLeaveNoSeparators) {
  EXPECT_STREQ(Error({.expected = "no"}).what(), "no");
  EXPECT_STREQ(Error({.file = "f", .expected = "no"}).what(), "f: no");
  EXPECT_STREQ(Error({.where = "radius", .expected = "no", .remedy = "yes"}).what(), "radius: no; yes");
}

TEST(Error, MessagesAreShortWhateverTheyQuote) {
  const std::string word(1000, 'x');
  const Error error({.file = "f", .where = "/a" + word + "/z", .expected = "found " + word, .remedy = "fix it"});
  const std::string message = error.what();
  EXPECT_EQ(message.size(), 201U) << "200 beside the file";
  EXPECT_TRUE(message.starts_with("f: /axxx")) << message;
  EXPECT_NE(message.find("xx/z: found xxx"), std::string::npos) << message;
  EXPECT_TRUE(message.ends_with("xxx...; fix it")) << message;
  EXPECT_EQ(error.parts().expected.size(), 1006U);
}

TEST(Error, KeepsItsParts) {
  const Error error({.file = "f", .where = "w", .expected = "e", .remedy = "r"});
  EXPECT_EQ(error.parts().file, "f");
  EXPECT_EQ(error.parts().where, "w");
  EXPECT_EQ(error.parts().expected, "e");
  EXPECT_EQ(error.parts().remedy, "r");
}

}  // namespace
}  // namespace cloud2csg
