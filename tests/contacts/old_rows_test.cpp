// Histories of a list that is being replaced, in both forms in which they are kept.
#include "contacts/old_rows.hpp"

#include <gtest/gtest.h>

namespace grainray::test {
namespace {

// Rows 0: {4, 2}, 1: none, 2: {7}.
ContactList old_list(bool in_records) {
    ContactList list(Device::cpu);
    list.offsets.assign(std::vector<std::uint64_t>{0, 2, 2, 3});
    const std::vector<std::uint32_t> partners{4, 2, 7};
    const std::vector<Vec3f> history{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    if (!in_records) {
        list.partners.assign(partners);
        list.history.assign(history);
        return list;
    }
    std::vector<KeptPair> kept;
    for (std::size_t e = 0; e < partners.size(); ++e) kept.push_back({partners[e], history[e]});
    list.kept.assign(kept);
    return list;
}

TEST(OldRows, FindWhatIsKeptInEitherFormAndNothingElse) {
    for (const bool in_records : {false, true}) {
        const ContactList list = old_list(in_records);
        const OldRows rows(list);
        Vec3f h{-1, -1, -1};
        EXPECT_FALSE(rows.look_up(0, 7, h));  // another row's
        EXPECT_FALSE(rows.look_up(1, 4, h));
        EXPECT_FALSE(rows.look_up(2, 2, h));
        EXPECT_EQ(h, (Vec3f{-1, -1, -1}));  // untouched where nothing is found
        EXPECT_TRUE(rows.look_up(0, 2, h));
        EXPECT_EQ(h, (Vec3f{4, 5, 6}));
        EXPECT_TRUE(rows.look_up(2, 7, h));
        EXPECT_EQ(h, (Vec3f{7, 8, 9}));
    }
}

TEST(OldIndex, IsTheParticlesOwnNumberWhereTheOrderStayed) {
    EXPECT_EQ(OldIndex(Array<std::uint32_t>(Device::cpu))[5], 5u);
    EXPECT_EQ(OldIndex(Array<std::uint32_t>(Device::cpu, {3, 1, 2}))[0], 3u);
}

}  // namespace
}  // namespace grainray::test
