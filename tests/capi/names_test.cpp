// SPDX-License-Identifier: MIT
// What mien.h tells about names of controls.
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

class CapiNames : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  dna::DnaView view = dna::tiny_rig(arena);  // jawOpen, smileL, smileR

  RigHandle rig() {
    const std::vector<uint8_t> file = write_view(view);
    return create_rig(open_dna(file).get());
  }
};

TEST_F(CapiNames, MatchesNamesToRawControls) {
  const RigHandle made = rig();
  MienControlShare shares[MIEN_MOST_SHARES] = {};
  size_t count = 0;
  uint32_t how = 99;
  ASSERT_EQ(mien_rig_match(made.get(), "AU12", 4, shares, MIEN_MOST_SHARES, &count, &how), MIEN_OK);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(how, MIEN_NAME_MATCH_BOTH_SIDES);
  EXPECT_EQ(shares[0].control, 1u);
  EXPECT_EQ(shares[1].control, 2u);
  EXPECT_EQ(shares[0].weight, 1.0f);
  ASSERT_EQ(mien_rig_match(made.get(), "mouthSmileRight", 15, shares, 1, &count, &how), MIEN_OK);
  EXPECT_EQ(how, MIEN_NAME_MATCH_ALIAS);
  EXPECT_EQ(shares[0].control, 2u);
}

TEST_F(CapiNames, WritesAsManySharesAsFit) {
  const RigHandle made = rig();
  MienControlShare shares[2] = {{7, 7}, {7, 7}};
  size_t count = 0;
  uint32_t how = 0;
  ASSERT_EQ(mien_rig_match(made.get(), "smile", 5, shares, 1, &count, &how), MIEN_OK);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(shares[1].control, 7u);
  EXPECT_EQ(mien_rig_match(made.get(), "smile", 5, nullptr, 0, &count, &how), MIEN_OK);
  EXPECT_EQ(count, 2u);
}

TEST_F(CapiNames, RefusesWhatItDoesNotKnowAndWrongArguments) {
  const RigHandle made = rig();
  MienControlShare share = {};
  size_t count = 5;
  uint32_t how = 5;
  EXPECT_EQ(mien_rig_match(made.get(), "chin", 4, &share, 1, &count, &how), MIEN_ERROR_NAME);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(how, MIEN_NAME_MATCH_NONE);
  EXPECT_EQ(mien_rig_match(made.get(), nullptr, 0, &share, 1, &count, &how), MIEN_ERROR_NAME);
  EXPECT_EQ(mien_rig_match(nullptr, "a", 1, &share, 1, &count, &how), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_match(made.get(), nullptr, 1, &share, 1, &count, &how),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_match(made.get(), "a", 1, nullptr, 1, &count, &how), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_match(made.get(), "a", 1, &share, 1, nullptr, &how), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_match(made.get(), "a", 1, &share, 1, &count, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
}

TEST(CapiControlName, GivesTheUsualName) {
  char text[32] = {};
  size_t count = 0;
  ASSERT_EQ(mien_control_name("AU12_L", 6, text, sizeof text, &count), MIEN_OK);
  EXPECT_EQ(std::string(text, count), "mouthSmileLeft");
  text[3] = '!';
  ASSERT_EQ(mien_control_name("jaw_open", 8, text, 3, &count), MIEN_OK);
  EXPECT_EQ(count, 7u);
  EXPECT_EQ(std::string(text, 4), "jaw!") << "no more than fits";
  ASSERT_EQ(mien_control_name("jaw_open", 8, nullptr, 0, &count), MIEN_OK);
  EXPECT_EQ(mien_control_name("chin", 4, text, sizeof text, &count), MIEN_ERROR_NAME);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(mien_control_name(nullptr, 4, text, 1, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_control_name("a", 1, nullptr, 1, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_control_name("a", 1, text, 1, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien
