#include "core/nearest_name.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

TEST(NearestName, InsertionDeletionAndSubstitutionCostOne) {
  const std::vector<std::string> names{"sphere", "spiral", "sponge"};
  EXPECT_EQ(nearestName("sphere", names), "sphere");
  EXPECT_EQ(nearestName("spere", names), "sphere");
  EXPECT_EQ(nearestName("spiiral", names), "spiral");
  EXPECT_EQ(nearestName("sponce", names), "sponge");
  // Against a name that is two substitutions away.
  EXPECT_EQ(nearestName("abc", {"axx", "abcd"}), "abcd");
  EXPECT_EQ(nearestName("abcd", {"axxd", "abc"}), "abc");
}

TEST(NearestName, TheFirstOfEquallyNearOnes) {
  EXPECT_EQ(nearestName("bx", {"ax", "cx"}), "ax");
  EXPECT_EQ(nearestName("", {"long", "a"}), "a");
}

TEST(NearestName, NothingToChooseFrom) {
  EXPECT_EQ(nearestName("x", {}), "");
  EXPECT_EQ(nearName("x", {}), "");
}

TEST(NearestName, OnlyANearOneCanBeMeant) {
  EXPECT_EQ(nearName("at", {"att", "fov"}), "att");
  EXPECT_EQ(nearName("shape", {"shaep"}), "shaep");
  EXPECT_EQ(nearName("at", {"up"}), "");
  EXPECT_EQ(nearName("sphere", {"spiral"}), "");
}

}  // namespace
}  // namespace whit
