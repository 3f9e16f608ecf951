// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_t;
import halocline.link_table_t;
import halocline.packet_name_t;
import halocline.packet_outcome_t;
import java.util.ArrayList;
import java.util.List;
import java.util.Objects;

/** What the plugin of lcm-spy keeps and shows of messages, without a window: java halocline.spy.StoreTest */
public final class StoreTest {
  private static int failures = 0;

  private StoreTest() {}

  public static void main(String[] arguments) {
    aMatrixHasARowATransmitterAndAColumnAReceiver();
    everyFieldOfALinkButItsIdsCanBeChosen();
    partsOfATableArePutTogether();
    aVehicleOutOfTwoTicksIsGone();
    anOlderTableOfAnUnknownSessionBeginsAnotherRun();
    outcomesAreShownNewestFirstWithNameAndCause();
    outcomesLostOnTheBusAreCountedAndThoseThatComeTwiceAreNot();
    onlyTheNewestOutcomesAreKept();
    everyOutcomeHasANameAndACause();
    System.exit(failures == 0 ? 0 : 1);
  }

  private static void aMatrixHasARowATransmitterAndAColumnAReceiver() {
    LinkStore store = new LinkStore();
    store.put("LINKS.b", table(2, 5, 0, link(2, 1, 0.25)));
    store.put("LINKS.a", table(1, 5, 0, link(1, 2, 0.75)));
    LinkMatrix matrix = new LinkMatrix(store);
    matrix.refresh();
    expect("columns", List.of("transmitter", "a", "b"), columns(matrix));
    expect("first row", cells("a", null, 0.75), row(matrix, 0));
    expect("second row", cells("b", 0.25, null), row(matrix, 1));
    matrix.choose(LinkQuantity.named("path_state"));
    expect("words of a code", cells("a", null, "shadow"), row(matrix, 0));
  }

  private static void everyFieldOfALinkButItsIdsCanBeChosen() {
    List<String> labels = new ArrayList<>();
    for (LinkQuantity quantity : LinkQuantity.all()) labels.add(quantity.toString());
    for (String label : List.of("range, m", "SNR, dB", "capacity, bit/s", "receivable", "delivery probability", "multipath", "doppler spread, Hz")) {
      expect("choice of " + label, true, labels.contains(label));
    }
    expect("no ids", false, labels.contains("receiver id"));
  }

  private static void partsOfATableArePutTogether() {
    LinkStore store = new LinkStore();
    store.put("LINKS.a", table(1, 5, 0, link(1, 2, 0.5)));
    store.put("LINKS.a", table(1, 5, 0, link(1, 3, 0.6)));
    expect("receivers of both parts", List.of(1, 2, 3), store.snapshot().ids);
    store.put("LINKS.a", table(1, 6, 0, link(1, 3, 0.7)));
    expect("the next table replaces both", null, store.snapshot().link(1, 2));
  }

  private static void aVehicleOutOfTwoTicksIsGone() {
    LinkStore store = new LinkStore();
    store.put("LINKS.a", table(1, 5, 0));
    store.put("LINKS.b", table(2, 5, 0));
    store.put("LINKS.a", table(1, 6, 0));
    expect("one table may be lost on the bus", List.of(1, 2), store.snapshot().ids);
    store.put("LINKS.a", table(1, 7, 0));
    expect("two are not", List.of(1), store.snapshot().ids);
  }

  private static void anOlderTableOfAnUnknownSessionBeginsAnotherRun() {
    LinkStore store = new LinkStore();
    store.put("LINKS.a", table(1, 100, 0));
    store.put("LINKS.b", table(2, 5, 0));
    expect("late", List.of(1), store.snapshot().ids);
    store.put("LINKS.b", table(2, 5, 1));
    expect("another run", List.of(2), store.snapshot().ids);
  }

  private static void outcomesAreShownNewestFirstWithNameAndCause() {
    LinkStore vehicles = new LinkStore();
    vehicles.put("LINKS.a", table(1, 5, 0));
    OutcomeStore store = new OutcomeStore();
    store.put(outcome(0, packet_outcome_t.RECEIVED));
    packet_outcome_t collided = outcome(1, packet_outcome_t.COLLIDED);
    collided.acquisition_probability = 0.5;
    collided.num_colliders = 1;
    collided.colliders = new packet_name_t[] {new packet_name_t()};
    collided.colliders[0].source_id = 1;
    collided.colliders[0].packet_sequence = 7;
    store.put(collided);
    OutcomeTable table = new OutcomeTable(store, vehicles);
    table.refresh();
    expect("newest", List.of("collided", "with a:7"), row(table, 0).subList(4, 6));
    expect("older", List.of("received", "all bits right: draw 0.250, probability 0.500"), row(table, 1).subList(4, 6));
    expect("names, or ids without one", List.of("a:3", "id 2"), row(table, 0).subList(1, 3));
  }

  private static void outcomesLostOnTheBusAreCountedAndThoseThatComeTwiceAreNot() {
    OutcomeStore store = new OutcomeStore();
    for (int sequence : new int[] {4, 5, 5, 8, 7}) store.put(outcome(sequence, packet_outcome_t.RECEIVED));
    expect("received", 4L, store.received());
    expect("6 is missing", 1L, store.missed());
  }

  private static void onlyTheNewestOutcomesAreKept() {
    OutcomeStore store = new OutcomeStore();
    for (int sequence = 0; sequence < OutcomeStore.CAPACITY + 10; ++sequence) store.put(outcome(sequence, packet_outcome_t.RECEIVED));
    List<packet_outcome_t> kept = store.newestFirst();
    expect("bound", OutcomeStore.CAPACITY, kept.size());
    expect("oldest kept", 10L, kept.get(kept.size() - 1).sequence);
    expect("received", (long) OutcomeStore.CAPACITY + 10, store.received());
  }

  private static void everyOutcomeHasANameAndACause() {
    for (byte code = packet_outcome_t.RECEIVED; code <= packet_outcome_t.TOO_STEEP; ++code) {
      packet_outcome_t outcome = outcome(0, code);
      expect("name of " + code, false, OutcomeCause.name(outcome).startsWith("outcome"));
      expect("cause of " + code, false, OutcomeCause.cause(outcome, Integer::toString).isEmpty());
    }
    expect("propagation is none", "below cutoff", OutcomeCause.name(outcome(0, packet_outcome_t.BELOW_CUTOFF)));
  }

  private static link_table_t table(int vehicle, int second, long session, link_t... links) {
    link_table_t table = new link_table_t();
    table.utime = second * 1_000_000L;
    table.session = session;
    table.vehicle_id = vehicle;
    table.num_peers = links.length;
    table.peers = links;
    return table;
  }

  private static link_t link(int from, int to, double delivery) {
    link_t link = new link_t();
    link.transmitter_id = from;
    link.receiver_id = to;
    link.delivery_probability = delivery;
    link.path_state = link_t.PATH_SHADOW;
    return link;
  }

  private static packet_outcome_t outcome(int sequence, byte code) {
    packet_outcome_t outcome = new packet_outcome_t();
    outcome.utime = sequence * 1_000_000L;
    outcome.sequence = sequence;
    outcome.source_id = 1;
    outcome.packet_sequence = 3;
    outcome.receiver_id = 2;
    outcome.outcome = code;
    outcome.success_probability = 0.5;
    outcome.success_draw = 0.25;
    outcome.colliders = new packet_name_t[0];
    return outcome;
  }

  private static List<Object> columns(javax.swing.table.TableModel model) {
    List<Object> names = new ArrayList<>();
    for (int column = 0; column < model.getColumnCount(); ++column) names.add(model.getColumnName(column));
    return names;
  }

  private static List<Object> row(javax.swing.table.TableModel model, int row) {
    List<Object> values = new ArrayList<>();
    for (int column = 0; column < model.getColumnCount(); ++column) values.add(model.getValueAt(row, column));
    return values;
  }

  private static List<Object> cells(Object... values) {
    return java.util.Arrays.asList(values);
  }

  private static void expect(String what, Object wanted, Object got) {
    if (Objects.equals(wanted, got)) return;
    System.err.println(what + ": expected " + wanted + ", got " + got);
    ++failures;
  }
}
