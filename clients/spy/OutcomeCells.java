// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import java.awt.Color;
import java.awt.Component;
import java.util.Map;
import javax.swing.JTable;
import javax.swing.table.DefaultTableCellRenderer;

/** An outcome with its mark, in Okabe and Ito's colours, which colour-blind eyes can tell apart. */
final class OutcomeCells extends DefaultTableCellRenderer {
  private static final Map<String, String> MARKS = Map.of("received", "\u25cf", "not acquired", "\u25cb", "bit errors", "\u2715",
      "collided", "\u29d3", "half duplex", "\u25ae");
  private static final Map<String, Color> COLOURS = Map.of("received", new Color(0x009e73), "not acquired", new Color(0xb07800),
      "bit errors", new Color(0xd55e00), "collided", new Color(0xcc79a7), "half duplex", new Color(0x0072b2));
  private static final String OTHER_MARK = "\u2013";
  private static final Color OTHER = new Color(0x666666);

  @Override
  public Component getTableCellRendererComponent(JTable table, Object value, boolean selected, boolean focus, int row, int column) {
    String outcome = String.valueOf(value);
    super.getTableCellRendererComponent(table, MARKS.getOrDefault(outcome, OTHER_MARK) + " " + outcome, selected, focus, row, column);
    if (!selected) setForeground(COLOURS.getOrDefault(outcome, OTHER));
    return this;
  }
}
