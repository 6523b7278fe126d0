#include "core/text.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

struct Typed {
  const char* text;
  std::vector<std::string> names;
  const char* meant;
};

void expectMeant(const std::vector<Typed>& rows) {
  for (const Typed& row : rows) EXPECT_EQ(nearestName(row.text, row.names), row.meant) << row.text;
}

TEST(NearestName, InsertionDeletionAndSubstitutionCostOne) {
  const std::vector<std::string> names{"sphere", "spiral", "sponge"};
  expectMeant({{"sphere", names, "sphere"},
               {"spere", names, "sphere"},
               {"spiiral", names, "spiral"},
               {"sponce", names, "sponge"},
               // The other name is two substitutions away.
               {"abc", {"axx", "abcd"}, "abcd"},
               {"abcd", {"axxd", "abc"}, "abc"},
               // Of equally near ones it is the first.
               {"bx", {"ax", "cx"}, "ax"}});
}

TEST(NearestName, OnlyANearOneCanBeMeant) {
  expectMeant({{"x", {}, ""},
               {"at", {"att", "fov"}, "att"},
               {"shape", {"shaep"}, "shaep"},
               {"at", {"up"}, ""},
               {"sphere", {"spiral"}, ""},
               {"helmet.glb", {"merge", "render"}, ""}});
  EXPECT_EQ(didYouMean("rendre", {"merge", "render"}), "; did you mean 'render'?");
  EXPECT_EQ(didYouMean("x", {}), "");
}

TEST(NearestName, ShortWordsNeedToBeNearer) {
  expectMeant({{"--az", {"--at", "--up"}, "--at"},
               {"--gh", {"--at", "--up"}, ""},
               {"--dpeth", {"--depth"}, "--depth"}});
}

TEST(NearestName, ABeginningStandsForItsOnlyName) {
  expectMeant({{"ref", {"packets", "reference"}, "reference"},
               {"--amb", {"--ambient", "--ambient-samples"}, ""},  // two begin so
               {"re", {"packets", "reference"}, ""}});
}

// DeadEnds has more of these words.
TEST(NearestName, WordsOfOtherProgramsLeadToOurs) {
  expectMeant({{"--samples", {"--sample", "--spp"}, "--spp"},
               {"samples", {"spp"}, "spp"},
               {"--samples", {"--sample"}, "--sample"}});  // there is no --spp
}

}  // namespace
}  // namespace whit
