// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_t;
import javax.swing.table.AbstractTableModel;

/** The chosen quantity of every link: a row a transmitter, a column a receiver. For the event thread alone. */
final class LinkMatrix extends AbstractTableModel implements Refreshed {
  private final LinkStore store;
  private LinkStore.Snapshot shown = new LinkStore.Snapshot();
  private LinkQuantity quantity = LinkQuantity.named("delivery_probability");
  private double least, greatest;  // of the values shown

  LinkMatrix(LinkStore store) {
    this.store = store;
  }

  void choose(LinkQuantity chosen) {
    quantity = chosen;
    findBounds();
    fireTableDataChanged();
  }

  LinkQuantity quantity() {
    return quantity;
  }

  @Override
  public void refresh() {
    LinkStore.Snapshot old = shown;
    shown = store.snapshot();
    boolean same = old.ids.equals(shown.ids);
    for (int id : shown.ids) same = same && old.name(id).equals(shown.name(id));
    findBounds();
    if (same) {
      fireTableDataChanged();
    } else {
      fireTableStructureChanged();
    }
  }

  @Override
  public String status() {
    if (shown.utime < 0) return "no LINKS yet";
    return shown.ids.size() + " vehicles at " + Texts.seconds(shown.utime) + " s; rows transmit, columns receive";
  }

  @Override
  public int getRowCount() {
    return shown.ids.size();
  }

  @Override
  public int getColumnCount() {
    return 1 + shown.ids.size();
  }

  @Override
  public String getColumnName(int column) {
    return column == 0 ? "transmitter" : shown.name(shown.ids.get(column - 1));
  }

  /** The transmitter's name; a Double or words; null where no link was published. */
  @Override
  public Object getValueAt(int row, int column) {
    int transmitter = shown.ids.get(row);
    if (column == 0) return shown.name(transmitter);
    link_t link = shown.link(transmitter, shown.ids.get(column - 1));
    return link == null ? null : quantity.value(link);
  }

  /** Where a value lies between the least and the greatest of the matrix, 0 to 1; probabilities as they are. */
  double share(double value) {
    if (quantity.isProbability()) return value;
    return greatest > least ? (value - least) / (greatest - least) : 0;
  }

  private void findBounds() {
    least = Double.POSITIVE_INFINITY;
    greatest = Double.NEGATIVE_INFINITY;
    for (int row = 0; row < getRowCount(); ++row) {
      for (int column = 1; column < getColumnCount(); ++column) {
        Object value = getValueAt(row, column);
        if (!(value instanceof Double)) continue;
        least = Math.min(least, (Double) value);
        greatest = Math.max(greatest, (Double) value);
      }
    }
  }
}
