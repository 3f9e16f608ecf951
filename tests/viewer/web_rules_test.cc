// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_rules.h"

#include <optional>
#include <string_view>

#include <gtest/gtest.h>

namespace halocline::monitor {
namespace {

const WebAccess kOwn{.port = 8042};
const WebAccess kGuarded{.address = "0.0.0.0", .port = 8042, .token = "s3cret"};

TEST(WebRules, OwnPageIsAllowed) {
  EXPECT_EQ(judge(kOwn, {.target = "/", .host = "127.0.0.1:8042"}), WebVerdict::kAllowed);
  EXPECT_EQ(judge(kOwn, {.target = "/ws", .host = "localhost:8042", .origin = "http://localhost:8042"}),
            WebVerdict::kAllowed);
  EXPECT_EQ(judge(kOwn, {.target = "/ws", .host = "[::1]:8042", .origin = "http://[::1]:8042"}),
            WebVerdict::kAllowed);
}

TEST(WebRules, PageOfAnotherOriginIsForbidden) {
  for (const char* origin :
       {"http://evil.example", "https://127.0.0.1:8042", "http://127.0.0.1:8043", "null", "file://"}) {
    EXPECT_EQ(judge(kOwn, {.target = "/ws", .host = "127.0.0.1:8042", .origin = origin}),
              WebVerdict::kForbidden)
        << origin;
  }
}

TEST(WebRules, ReboundHostIsForbidden) {
  for (const char* host : {"evil.example:8042", "evil.example", "127.0.0.1", "127.0.0.1:80",
                           "127.0.0.1:8042.evil.example", ""}) {
    EXPECT_EQ(judge(kOwn, {.target = "/", .host = host}), WebVerdict::kForbidden) << host;
  }
  EXPECT_EQ(judge(kOwn, {.target = "/ws", .host = "evil.example:8042", .origin = "http://evil.example:8042"}),
            WebVerdict::kForbidden);
}

TEST(WebRules, OriginThatWasAllowedMayConnect) {
  WebAccess access = kOwn;
  access.allowed_origins = {"https://app.foxglove.dev"};
  const WebRequest request{.target = "/ws", .host = "localhost:8042", .origin = "https://app.foxglove.dev"};
  EXPECT_EQ(judge(access, request), WebVerdict::kAllowed);
  EXPECT_EQ(judge(kOwn, request), WebVerdict::kForbidden);
}

TEST(WebRules, TokenIsDemanded) {
  const auto of = [](std::string_view target, std::string_view authorization, std::string_view cookie) {
    return judge(
        kGuarded,
        {.target = target, .host = "boat.lan:8042", .authorization = authorization, .cookie = cookie});
  };
  EXPECT_EQ(of("/", "", ""), WebVerdict::kUnauthorized);
  EXPECT_EQ(of("/?token=s3cret", "", ""), WebVerdict::kAllowed);
  EXPECT_EQ(of("/?view=chart&token=s3cre%74", "", ""), WebVerdict::kAllowed);
  EXPECT_EQ(of("/", "Bearer s3cret", ""), WebVerdict::kAllowed);
  EXPECT_EQ(of("/", "", "a=b; halocline_token_8042=s3cret"), WebVerdict::kAllowed);
  for (const char* wrong :
       {"/?token=", "/?token=s3cre", "/?token=s3crets", "/?token=S3CRET", "/?tokens=s3cret", "/token=s3cret"})
    EXPECT_EQ(of(wrong, "", ""), WebVerdict::kUnauthorized) << wrong;
  EXPECT_EQ(of("/", "bearer s3cret", ""), WebVerdict::kUnauthorized);
  EXPECT_EQ(of("/", "", "halocline_token_8043=s3cret"), WebVerdict::kUnauthorized);
}

TEST(WebRules, EmptySecretEqualsNothing) {
  EXPECT_FALSE(equal_in_constant_time("", ""));
  EXPECT_FALSE(equal_in_constant_time("a", ""));
  EXPECT_TRUE(equal_in_constant_time("ab", "ab"));
  EXPECT_FALSE(equal_in_constant_time("abab", "ab"));
}

TEST(WebRules, FilesLieWithinTheBundle) {
  EXPECT_EQ(bundle_file("/"), "index.html");
  EXPECT_EQ(bundle_file("/?token=a/../b"), "index.html");
  EXPECT_EQ(bundle_file("/assets/index-B3x.js?v=1"), "assets/index-B3x.js");
  for (const char* wrong :
       {"/../etc/passwd", "/assets/../../etc/passwd", "/%2e%2e/etc/passwd", "/..%2fetc/passwd", "/.sources",
        "/assets/.git/config", "//etc/passwd", "/a//b", "/a\\b", "/%5c..%5cb", "/%00", "/a%0ab", "/%2",
        "/%zz", "etc/passwd", "", "/assets/", "/C:/x"})
    EXPECT_EQ(bundle_file(wrong), std::nullopt) << wrong;
}

TEST(WebRules, NamesWithAHashAreKeptForEver) {
  EXPECT_NE(cache_control("assets/index-B3x.js").find("immutable"), std::string_view::npos);
  EXPECT_EQ(cache_control("index.html"), "no-cache");
  EXPECT_EQ(mime_type("assets/index-B3x.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(mime_type("a.woff2"), "font/woff2");
  EXPECT_EQ(mime_type("strange"), "application/octet-stream");
}

TEST(WebRules, FirstKnownProtocolIsChosen) {
  EXPECT_EQ(choose_protocol("x, halocline.monitor.v1", {"foxglove.websocket.v1", "halocline.monitor.v1"}),
            "halocline.monitor.v1");
  EXPECT_EQ(choose_protocol("halocline.monitor.v2", {"halocline.monitor.v1"}), "");
  EXPECT_EQ(choose_protocol("", {"halocline.monitor.v1"}), "");
}

}  // namespace
}  // namespace halocline::monitor
