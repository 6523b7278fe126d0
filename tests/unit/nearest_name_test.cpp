#include "core/text.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

TEST(NearestName, InsertionDeletionAndSubstitutionCostOne) {
  const std::vector<std::string> names{"sphere", "spiral", "sponge"};
  EXPECT_EQ(nearestName("sphere", names), "sphere");
  EXPECT_EQ(nearestName("spere", names), "sphere");
  EXPECT_EQ(nearestName("spiiral", names), "spiral");
  EXPECT_EQ(nearestName("sponce", names), "sponge");

  // The other name is two substitutions away.
  EXPECT_EQ(nearestName("abc", {"axx", "abcd"}), "abcd");
  EXPECT_EQ(nearestName("abcd", {"axxd", "abc"}), "abc");
}

TEST(NearestName, TheFirstOfEquallyNearOnes) { EXPECT_EQ(nearestName("bx", {"ax", "cx"}), "ax"); }

TEST(NearestName, NothingToChooseFrom) {
  EXPECT_EQ(nearestName("x", {}), "");
  EXPECT_EQ(didYouMean("x", {}), "");
}

TEST(NearestName, OnlyANearOneCanBeMeant) {
  EXPECT_EQ(nearestName("at", {"att", "fov"}), "att");
  EXPECT_EQ(nearestName("shape", {"shaep"}), "shaep");
  EXPECT_EQ(nearestName("at", {"up"}), "");
  EXPECT_EQ(nearestName("sphere", {"spiral"}), "");
  EXPECT_EQ(nearestName("helmet.glb", {"merge", "render"}), "");
  EXPECT_EQ(didYouMean("rendre", {"merge", "render"}), "; did you mean 'render'?");
}

TEST(NearestName, ShortWordsNeedToBeNearer) {
  EXPECT_EQ(nearestName("--az", {"--at", "--up"}), "--at");
  EXPECT_EQ(nearestName("--gh", {"--at", "--up"}), "");
  EXPECT_EQ(nearestName("--dpeth", {"--depth"}), "--depth");
}

TEST(NearestName, ABeginningStandsForItsOnlyName) {
  EXPECT_EQ(nearestName("ref", {"packets", "reference"}), "reference");
  EXPECT_EQ(nearestName("--amb", {"--ambient", "--ambient-samples"}), "");  // two begin so
  EXPECT_EQ(nearestName("re", {"packets", "reference"}), "");
}

TEST(NearestName, WordsOfOtherProgramsLeadToOurs) {
  const std::vector<std::string> names{"--spp",     "--size", "--ambient-samples", "--indirect",
                                       "--threads", "--at",   "--sample"};
  EXPECT_EQ(nearestName("--samples", names), "--spp");
  EXPECT_EQ(nearestName("--width", names), "--size");
  EXPECT_EQ(nearestName("--ao", names), "--ambient-samples");
  EXPECT_EQ(nearestName("--gi", names), "--indirect");
  EXPECT_EQ(nearestName("-j", names), "--threads");
  EXPECT_EQ(nearestName("samples", {"spp"}), "spp");
  EXPECT_EQ(nearestName("--samples", {"--sample"}), "--sample");  // there is no --spp
}

}  // namespace
}  // namespace whit
