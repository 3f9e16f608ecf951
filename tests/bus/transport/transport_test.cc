// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/transport.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline::bus {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(const std::string& url) {
  try {
    open_transport(url);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(Transport, TakesTheGivenUrlThenTheEnvironmentThenTheDefault) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(effective_url(""), kDefaultUrl);
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(effective_url(""), "memq://");
  EXPECT_EQ(effective_url("udpm://239.1.1.1:9?recv_buf_size=1"), "udpm://239.1.1.1:9?recv_buf_size=1");
  unsetenv("LCM_DEFAULT_URL");
}

TEST(Transport, RequestsABufferThatHoldsABurst) {
  EXPECT_EQ(effective_url("udpm://239.1.1.1:9"), "udpm://239.1.1.1:9?recv_buf_size=4194304");
  EXPECT_EQ(effective_url("udpm://239.1.1.1:9?ttl=1"), "udpm://239.1.1.1:9?ttl=1&recv_buf_size=4194304");
}

TEST(Transport, RefusesOtherProviders) {
  for (const char* url :
       {"tcpq://127.0.0.1:7700", "file:///tmp/x.lcmlog", "nonsense", "mpudpm://239.1.1.1:9"}) {
    EXPECT_THAT(refusal_of(url), HasSubstr("allowed are udpm://")) << url;
    EXPECT_THAT(refusal_of(url), HasSubstr(url));
  }
}

TEST(Transport, RefusesWhatIsNoGroupOrNoPort) {
  for (const char* url :
       {"udpm://not-an-address:7667", "udpm://239.1.1.1:x", "udpm://239.1.1.1?ttl=1", "udpm://10.0.0.1:7667"})
    EXPECT_THAT(refusal_of(url), HasSubstr("allowed are udpm://GROUP:PORT")) << url;
}

TEST(Transport, OpensAQueueInMemory) { EXPECT_TRUE(open_transport("memq://")->good()); }

TEST(Transport, WarnsOnlyOfNetworkBuffers) { EXPECT_EQ(receive_buffer_warning("memq://"), ""); }

}  // namespace
}  // namespace halocline::bus
