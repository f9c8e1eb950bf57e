// Files that get their name when they are whole.
#include "base/part_file.h"

#include <gtest/gtest.h>

#include <string>

#include "base/errors.h"
#include "support/temporary_folder.h"

namespace smokebox {
namespace {

TEST(PartFile, HasItsNameOnlyWhenItIsWhole) {
  // Truth: what is not committed leaves nothing, also of what a killed run left; what is committed replaces.
  TemporaryFolder folder;
  writeText(folder / "x.txt", "old");
  writeText(folder / "x.txt.part", "left by a run that was killed");
  {
    const PartFile part(folder / "x.txt");
    writeText(part.path(), "half");
  }
  EXPECT_EQ(folder.names(), std::set<std::string>{"x.txt"});
  EXPECT_EQ(fileText(folder / "x.txt"), "old");
  writeWholeFile(folder / "x.txt", "new");
  EXPECT_EQ(folder.names(), std::set<std::string>{"x.txt"});
  EXPECT_EQ(fileText(folder / "x.txt"), "new");
}

TEST(PartFile, IsWrittenByOneAtATime) {
  // Truth: a second writer of one file is refused, however it spells the name, and takes nothing from the
  // first; when that one is done, it may.
  TemporaryFolder folder;
  const auto target = folder / "x.txt";
  {
    PartFile part(target);
    writeText(part.path(), "whole");
    for (const auto& name : {target, folder / "." / "x.txt"}) {
      try {
        const PartFile second(name);
        ADD_FAILURE() << name;
      } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("is being written already"), std::string::npos);
      }
    }
    EXPECT_NO_THROW(PartFile(folder / "y.txt"));
    part.commit();
  }
  EXPECT_EQ(fileText(target), "whole");
  EXPECT_NO_THROW(PartFile{target});
  EXPECT_EQ(folder.names(), std::set<std::string>{"x.txt"});
}

}  // namespace
}  // namespace smokebox
