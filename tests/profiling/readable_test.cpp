// tests/profiling/readable_test.cpp
#include "profiling/readable.h"
#include <gtest/gtest.h>
#include "profiling/palette.h"

using namespace skred;

TEST(Readable, TimesHaveThreeDigitsAndAUnit) {
  EXPECT_EQ(readable_time(0), "0 s");
  EXPECT_EQ(readable_time(31e-9), "31.0 ns");
  EXPECT_EQ(readable_time(1.5e-12), "0.00 ns");
  EXPECT_EQ(readable_time(4.567e-6), "4.57 us");
  EXPECT_EQ(readable_time(4.567e-6, "\u00b5"), "4.57 \u00b5s");
  EXPECT_EQ(readable_time(0.0123), "12.3 ms");
  EXPECT_EQ(readable_time(0.9994), "999 ms");
  EXPECT_EQ(readable_time(0.9996), "1.00 s");
  EXPECT_EQ(readable_time(99.96), "100 s");
  EXPECT_EQ(readable_time(123456), "123456 s");
}

TEST(Readable, CountsAndShares) {
  EXPECT_EQ(readable_count(0), "0");
  EXPECT_EQ(readable_count(999), "999");
  EXPECT_EQ(readable_count(1234), "1.23 k");
  EXPECT_EQ(readable_count(999600), "1.00 M");
  EXPECT_EQ(readable_count(4.5e10), "45.0 G");
  EXPECT_EQ(readable_share(0), "0 %");
  EXPECT_EQ(readable_share(0.00001), "< 0.01 %");
  EXPECT_EQ(readable_share(0.0004), "0.04 %");
  EXPECT_EQ(readable_share(0.523), "52.3 %");
  EXPECT_EQ(readable_share(1), "100.0 %");
  EXPECT_EQ(grouped_digits(7), "7");
  EXPECT_EQ(grouped_digits(95052), "95\u00a0052");
  EXPECT_EQ(grouped_digits(-1234567), "-1\u00a0234\u00a0567");
}

TEST(Palette, NamedKernelsDifferAndUnknownOnesKeepTheirColour) {
  EXPECT_NE(kernel_colour("broadphase").hex, kernel_colour("broadphase_body").hex);
  EXPECT_EQ(kernel_colour("a kernel of tomorrow").hex, kernel_colour("a kernel of tomorrow").hex);
  EXPECT_EQ(kernel_colour("a kernel of tomorrow").hex.size(), 7u);
}
