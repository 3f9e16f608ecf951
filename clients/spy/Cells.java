// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import java.awt.Color;
import java.awt.Component;
import java.util.function.ToDoubleFunction;
import javax.swing.JTable;
import javax.swing.SwingConstants;
import javax.swing.table.DefaultTableCellRenderer;

/** Numbers in few digits at the right of their cell, shaded by a share of 0 to 1 where one is given. */
final class Cells extends DefaultTableCellRenderer {
  private static final Color LIGHT = new Color(0xffffff), DARK = new Color(0x7fb8d8);

  private final ToDoubleFunction<Double> share;

  /** `share`: null for no shade. */
  Cells(ToDoubleFunction<Double> share) {
    this.share = share;
  }

  @Override
  public Component getTableCellRendererComponent(JTable table, Object value, boolean selected, boolean focus, int row, int column) {
    super.getTableCellRendererComponent(table, value instanceof Double ? Texts.number((Double) value) : value, selected, focus, row, column);
    setHorizontalAlignment(value instanceof Double ? SwingConstants.RIGHT : SwingConstants.LEFT);
    if (!selected) setBackground(share != null && value instanceof Double ? between(share.applyAsDouble((Double) value)) : LIGHT);
    return this;
  }

  private static Color between(double share) {
    double bounded = Math.max(0, Math.min(1, share));
    return new Color(mixed(LIGHT.getRed(), DARK.getRed(), bounded), mixed(LIGHT.getGreen(), DARK.getGreen(), bounded),
        mixed(LIGHT.getBlue(), DARK.getBlue(), bounded));
  }

  private static int mixed(int from, int to, double share) {
    return (int) Math.round(from + share * (to - from));
  }
}
