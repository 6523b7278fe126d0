// Quotas of control groups, read from folders that look like the kernel's.
#include "core/worker_pool.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

namespace whit {
namespace {

namespace fs = std::filesystem;

class CgroupQuota : public testing::Test {
 protected:
  CgroupQuota() {
    std::string name = (fs::temp_directory_path() / "whit-cgroup-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    root_ = name;
  }
  ~CgroupQuota() override { fs::remove_all(root_); }

  void put(const std::string& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << '\n';
  }

  fs::path root_;
};

TEST_F(CgroupQuota, VersionTwo) {
  EXPECT_EQ(cgroupQuota("0::/\n", root_), 0);
  put("cpu.max", "max 100000");
  EXPECT_EQ(cgroupQuota("0::/\n", root_), 0);
  put("cpu.max", "150000 100000");
  EXPECT_EQ(cgroupQuota("0::/\n", root_), 1.5);
}

TEST_F(CgroupQuota, TheLeastOfAllAboveCounts) {
  put("a.slice/b.service/cpu.max", "400000 100000");
  put("a.slice/cpu.max", "200000 100000");
  put("cpu.max", "max 100000");
  EXPECT_EQ(cgroupQuota("0::/a.slice/b.service\n", root_), 2);
  EXPECT_EQ(cgroupQuota("0::/\n", root_), 0);

  put("a.slice/b.service/cpu.max", "50000 100000");
  EXPECT_EQ(cgroupQuota("0::/a.slice/b.service\n", root_), 0.5);
}

// The membership names groups of the host, which a container does not see.
TEST_F(CgroupQuota, InAContainerTheRootCounts) {
  put("cpu.max", "250000 100000");
  EXPECT_EQ(cgroupQuota("0::/docker/0123abcd\n", root_), 2.5);
}

TEST_F(CgroupQuota, NonsenseIsNoLimit) {
  put("cpu.max", "many things");
  for (const char* membership : {"", "::", "0:\n", "no colons", "0::/../../..\n"}) {
    EXPECT_EQ(cgroupQuota(membership, root_ / "deep/er/than/that"), 0) << membership;
  }

  EXPECT_EQ(cgroupQuota("0::/\n", root_), 0);
  put("cpu.max", "100000 0");
  EXPECT_EQ(cgroupQuota("0::/\n", root_), 0);
}

TEST(UsableThreads, ThereIsAtLeastOne) { EXPECT_GE(usableThreads(), 1); }

}  // namespace
}  // namespace whit
