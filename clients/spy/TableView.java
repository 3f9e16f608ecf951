// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.util.function.Supplier;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JCheckBox;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.JLabel;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import javax.swing.Timer;

/** A table that refreshes itself, with its controls above and what it shows in one line. */
final class TableView extends JPanel {
  private static final int PERIOD_MS = 250;

  private final Refreshed model;
  private final JLabel status = new JLabel();
  private final JCheckBox hold = new JCheckBox("hold");
  private final Timer timer = new Timer(PERIOD_MS, event -> refresh());

  TableView(Refreshed model, JTable table, JComponent... controls) {
    super(new BorderLayout());
    this.model = model;
    JPanel bar = new JPanel(new FlowLayout(FlowLayout.LEFT));
    for (JComponent control : controls) bar.add(control);
    bar.add(hold);
    bar.add(status);
    add(bar, BorderLayout.NORTH);
    add(new JScrollPane(table), BorderLayout.CENTER);
    refresh();
    timer.start();
  }

  private void refresh() {
    if (!hold.isSelected()) model.refresh();
    status.setText(model.status());
  }

  /** The action by which lcm-spy opens such a view. With a null desktop, as lcm-spy calls it for the name alone, it does nothing. */
  static Action opening(String name, JDesktopPane desktop, Dimension size, Supplier<TableView> made) {
    return new AbstractAction(name) {
      @Override
      public void actionPerformed(ActionEvent event) {
        if (desktop != null) made.get().fill(desktop, name, size);
      }
    };
  }

  private void fill(JDesktopPane desktop, String name, Dimension size) {
    desktop.setLayout(new BorderLayout());
    desktop.add(this, BorderLayout.CENTER);
    Window window = SwingUtilities.getWindowAncestor(desktop);
    if (window == null) return;
    if (window instanceof JFrame) ((JFrame) window).setTitle(name);
    window.addWindowListener(new WindowAdapter() {
      @Override
      public void windowClosing(WindowEvent event) {
        timer.stop();
        window.dispose();
      }
    });
    window.setSize(size);
    window.validate();
  }
}
