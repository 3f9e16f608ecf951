// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of clients/modem_gateway/, compiled and run
// (tests/docs/check_examples).
#include <string>

#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/interface_options.h"

namespace halocline::modem_gateway {
namespace {

TEST(HeaderExamples, InterfaceOptions) {
  InterfaceOptions options("revision=0.94.0.00");
  const std::string revision = options.take("revision", "2.0.31000");
  options.require_all_taken();
  EXPECT_EQ(revision, "0.94.0.00");
}

}  // namespace
}  // namespace halocline::modem_gateway
