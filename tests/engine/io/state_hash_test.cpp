// tests/engine/io/state_hash_test.cpp - published values of FNV-1a, and what must and must not change a hash.
#include "engine/io/state_hash.h"
#include <gtest/gtest.h>
#include <string_view>
#include "engine/vec3.h"

using namespace skred;

namespace {

template <class... Parts> std::uint64_t hash(const Parts&... parts) {
  StateHash h;
  (h.add(parts), ...);
  return h.value();
}

std::uint64_t of_text(std::string_view text) {
  StateHash h;
  h.add(std::as_bytes(std::span(text)));
  return h.value();
}

}  // namespace

// Test vectors of the authors (Fowler, Noll, Vo: fnv-1a 64 bit).
TEST(StateHash, PublishedValues) {
  EXPECT_EQ(of_text(""), 0xcbf29ce484222325ull);
  EXPECT_EQ(of_text("a"), 0xaf63dc4c8601ec8cull);
  EXPECT_EQ(of_text("foobar"), 0x85944171f73967e8ull);
}

TEST(StateHash, ChangesWithEveryBitOrderAndLength) {
  const std::vector<Vec3> a{{1, 2, 3}, {4, 5, 6}};
  auto b = a;
  EXPECT_EQ(hash(a), hash(b));
  b[1].z = std::nextafter(6.0, 7.0);
  EXPECT_NE(hash(a), hash(b));
  EXPECT_NE(hash(0.0), hash(-0.0));
  EXPECT_NE(hash(std::vector<double>{1, 2}), hash(std::vector<double>{2, 1}));
  EXPECT_NE(hash(std::vector<double>{1}, std::vector<double>{2, 3}), hash(std::vector<double>{1, 2}, std::vector<double>{3}));
  EXPECT_NE(hash(std::vector<double>{}), hash());
}

TEST(StateHash, HexHasSixteenDigits) {
  EXPECT_EQ(StateHash().hex(), "cbf29ce484222325");
  StateHash h;
  h.add(std::int64_t{7});
  EXPECT_EQ(h.hex().size(), 16u);
  EXPECT_EQ(std::stoull(h.hex(), nullptr, 16), h.value());
}
