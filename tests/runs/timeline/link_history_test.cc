// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/link_history.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

link_table_t table(std::int32_t from, std::initializer_list<std::int32_t> peers, double snr_db) {
  link_table_t t{};
  t.vehicle_id = from;
  for (const std::int32_t peer : peers) {
    link_t row{};
    row.transmitter_id = from;
    row.receiver_id = peer;
    row.snr_db = snr_db;
    t.peers.push_back(row);
  }
  t.num_peers = static_cast<std::int32_t>(t.peers.size());
  return t;
}

TEST(LinkHistory, ARowIsThatOfTheLastTableOfATimeOrBefore) {
  LinkHistory links;
  for (int s = 0; s < 5; ++s) links.add(at(s), table(1, {3, 2}, s));
  EXPECT_EQ(links.row_at(1, 2, at(3.7))->snr_db, 3);
  EXPECT_EQ(links.row_at(1, 2, at(99))->snr_db, 4);
  EXPECT_EQ(links.row_at(1, 2, at(-1)), nullptr);
  EXPECT_EQ(links.row_at(1, 4, at(3)), nullptr);
  EXPECT_EQ(links.row_at(2, 1, at(3)), nullptr);
  EXPECT_EQ(links.row_count(), 10u);
}

TEST(LinkHistory, PartsOfATableAreOneTable) {
  LinkHistory links;
  links.add(at(1), table(1, {2, 3}, 5));
  links.add(at(1), table(1, {4, 5}, 6));
  links.add(at(1), table(1, {4, 5}, 7));  // again
  EXPECT_EQ(links.row_at(1, 2, at(1))->snr_db, 5);
  EXPECT_EQ(links.row_at(1, 5, at(1))->snr_db, 6);
  EXPECT_EQ(links.row_count(), 4u);
}

TEST(LinkHistory, RowsOfAnInstantLeaveOutTablesThatAreTooOld) {
  LinkHistory links;
  links.add(at(1), table(1, {2}, 5));
  links.add(at(9), table(2, {1}, 6));
  EXPECT_EQ(links.rows_at(at(10), SimDuration::from_seconds(2)).size(), 1u);
  EXPECT_EQ(links.rows_at(at(10), SimDuration::from_seconds(20)).size(), 2u);
}

TEST(LinkHistory, TheCourseOfAColumnKeepsItsExtremes) {
  LinkHistory links;
  for (int s = 0; s < 3000; ++s) links.add(at(s), table(1, {2}, s == 1000 ? 77 : 0));
  const auto course = links.history(1, 2, *link_column("snr_db"), at(0), at(3000), 50);
  EXPECT_LE(course.size(), 50u);
  EXPECT_TRUE(std::any_of(course.begin(), course.end(),
                          [](const auto& entry) { return entry.value == 77 && entry.at == at(1000); }));
}

TEST(LinkHistory, RowsAreCountedThroughThinningAndDropping) {
  LinkHistory links;
  for (int s = 0; s < 101; ++s) links.add(at(s), table(1, {2, 3}, s));
  links.thin();
  EXPECT_EQ(links.row_count(), 102u);
  for (int s = 101; s < 201; ++s) links.add(at(s), table(1, {2, 3}, s));
  EXPECT_EQ(links.row_count(), 202u);
  links.drop_before(at(100));
  EXPECT_EQ(links.row_count(), 104u);  // and the one before, which holds at that instant
}

TEST(LinkColumns, AreTheFieldsOfALinkButItsEnds) {
  std::vector<std::string_view> fields;
  const auto note = [&](const MessageField& field, const auto&) { fields.push_back(field.name); };
  visit_fields(note, link_t{});
  ASSERT_EQ(fields.size(), link_columns().size() + 2);
  for (const LinkColumn& column : link_columns())
    EXPECT_NE(std::find(fields.begin(), fields.end(), column.key), fields.end()) << column.key;
  EXPECT_EQ(link_column("colour"), nullptr);
}

}  // namespace
}  // namespace halocline::clients
