#include <set>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/query/counters.h>
#include <strahl/traverse/mailbox.h>

namespace strahl {
namespace {

TEST(Mailbox, AdmitsEveryReferenceTheFirstTime) {
  Rng rng(1);
  for (int ray = 0; ray < 50; ++ray) {
    Mailbox mailbox;
    std::set<std::uint32_t> seen;
    for (int i = 0; i < 5000; ++i) {
      const std::uint32_t reference = rng.below(2) ? rng.below(4096) : 0xfffffffeu - rng.below(64);
      const bool is_new = seen.insert(reference).second;
      const bool is_admitted = mailbox.admit(reference);
      ASSERT_TRUE(is_admitted || !is_new) << reference;
    }
  }
}

TEST(Mailbox, TurnsAwayAsManyReferencesAsItHasSlots) {
  Mailbox mailbox;
  for (std::uint32_t i = 0; i < Mailbox::kSlots; ++i) EXPECT_TRUE(mailbox.admit(i));
  for (std::uint32_t i = 0; i < Mailbox::kSlots; ++i) EXPECT_FALSE(mailbox.admit(i));
}

TEST(Mailbox, ForgetsOnlyWhatSharesASlot) {
  Mailbox mailbox;
  EXPECT_TRUE(mailbox.admit(5));
  EXPECT_TRUE(mailbox.admit(5 + Mailbox::kSlots));
  EXPECT_TRUE(mailbox.admit(5));
  EXPECT_TRUE(mailbox.admit(6));
  EXPECT_FALSE(mailbox.admit(6));
  EXPECT_FALSE(mailbox.admit(5));
}

struct RecordingPrims {
  int visits = 0;
  bool visit(std::uint32_t reference, const PreparedRay&, int&, NoCounters&) {
    ++visits;
    return reference == 7;
  }
};

TEST(MailedPrims, VisitOnceAndPassOnTheWishToStop) {
  RecordingPrims prims;
  MailedPrims<RecordingPrims> mailed(prims);
  const PreparedRay ray{};
  int query = 0;
  NoCounters counters;
  EXPECT_FALSE(mailed.visit(3, ray, query, counters));
  EXPECT_FALSE(mailed.visit(3, ray, query, counters));
  EXPECT_EQ(prims.visits, 1);
  EXPECT_TRUE(mailed.visit(7, ray, query, counters));
}

}  // namespace
}  // namespace strahl
