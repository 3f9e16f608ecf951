// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.event.InputEvent;
import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.HashSet;
import java.util.List;
import java.util.Set;
import java.util.concurrent.Callable;
import java.util.concurrent.FutureTask;
import javax.imageio.ImageIO;
import javax.swing.JComboBox;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import javax.swing.table.TableModel;

/**
 * Uses lcm-spy as a person would, by the mouse, and writes what its windows show: java halocline.spy.SpyTour FOLDER
 *
 * Prints "ready" when lcm-spy listens; a run may start then. Opens a decoded channel, the link matrix and the outcomes while it goes on;
 * after a line on standard input, that it has ended, writes the pictures and, as tables separated by tabs, the models behind them.
 */
public final class SpyTour {
  private static final String SPY = "LCM Spy", DECODED = "STATE.scout-1", LINKS = "LINKS.quay", OUTCOME = "OUTCOME";
  private static final Rectangle SCREEN = new Rectangle(0, 0, 1500, 1200);
  private static final long PATIENCE_MS = 30_000;
  private static final int ATTEMPTS = 10;

  private final Path folder;
  private final Robot robot = new Robot();
  private final JTable channels;
  private final Set<String> opened = new HashSet<>(Set.of(SPY));

  public static void main(String[] arguments) throws Exception {
    lcm.spy.Spy.main(new String[0]);
    SpyTour tour = new SpyTour(Path.of(arguments[0]));
    try {
      tour.run();
      System.exit(0);
    } catch (Exception failure) {
      failure.printStackTrace();
      tour.picture("failure.png", SCREEN);
      System.exit(1);
    }
  }

  private SpyTour(Path folder) throws Exception {
    this.folder = folder;
    channels = onEventThread(() -> find(JTable.class, frame(SPY)));
  }

  private void run() throws Exception {
    System.out.println("ready");
    place(SPY, 0, 0, 800, 600);
    open(DECODED, DECODED);
    place(DECODED, 810, 0, 650, 600);
    open(OUTCOME, "Packet outcomes");
    place("Packet outcomes", 0, 610, 1250, 420);
    open(LINKS, "Link matrix");
    place("Link matrix", 0, 1040, 690, 150);
    Thread.sleep(2000);  // for the rates of lcm-spy and the course of the decoded numbers
    picture("lcm-spy.png", new Rectangle(0, 0, 1460, 600));
    new BufferedReader(new InputStreamReader(System.in)).readLine();
    Thread.sleep(1500);  // the last datagrams, the last refresh
    picture("lcm-spy-links.png", bounds("Link matrix"));
    picture("lcm-spy-outcomes.png", bounds("Packet outcomes"));
    write("channels", channelTypes());
    writeMatrix();
    writeOutcomes();
  }

  /** Names and types of all channels; LCM's own test of itself is not of the run. */
  private List<List<Object>> channelTypes() throws Exception {
    return onEventThread(() -> {
      List<List<Object>> rows = new ArrayList<>();
      for (int row = 0; row < channels.getRowCount(); ++row) {
        if (!"LCM_SELF_TEST".equals(channels.getValueAt(row, 0))) rows.add(List.of(channels.getValueAt(row, 0), channels.getValueAt(row, 1)));
      }
      return rows;
    });
  }

  /** The matrix of every quantity that its list offers. */
  private void writeMatrix() throws Exception {
    JComboBox<?> choice = onEventThread(() -> find(JComboBox.class, frame("Link matrix")));
    TableModel model = onEventThread(() -> find(JTable.class, frame("Link matrix")).getModel());
    for (int i = 0; i < choice.getItemCount(); ++i) {
      LinkQuantity quantity = (LinkQuantity) choice.getItemAt(i);
      write("links-" + quantity.name(), onEventThread(() -> {
        choice.setSelectedItem(quantity);
        return rows(model);
      }));
    }
  }

  private void writeOutcomes() throws Exception {
    TableModel model = onEventThread(() -> find(JTable.class, frame("Packet outcomes")).getModel());
    write("outcomes", onEventThread(() -> {
      List<List<Object>> rows = rows(model);
      rows.get(0).add(0, "sequence");
      for (int row = 1; row < rows.size(); ++row) rows.get(row).add(0, ((OutcomeTable) model).at(row - 1).sequence);
      return rows;
    }));
    write("counts", List.of(List.of(Recorder.shared().outcomes.received(), Recorder.shared().outcomes.missed())));
  }

  /** Clicks twice on a channel as soon as lcm-spy lists it, until its window is there. */
  private void open(String channel, String title) throws Exception {
    await("channel " + channel, () -> row(channel) >= 0);
    opened.add(title);
    for (int i = 0; frame(title) == null; ++i) {
      if (i == ATTEMPTS) throw new IllegalStateException("no window " + title + " after double clicks on " + channel);
      doubleClick(onEventThread(() -> placeOf(channel)));
      onEventThread(() -> {
        closeOthers();
        return null;
      });
    }
  }

  private Point placeOf(String channel) {
    channels.scrollRectToVisible(channels.getCellRect(row(channel), 0, true));
    Rectangle cell = channels.getCellRect(row(channel), 0, true);
    Point corner = channels.getLocationOnScreen();
    return new Point(corner.x + cell.x + 30, corner.y + cell.y + cell.height / 2);
  }

  private void doubleClick(Point place) throws Exception {
    robot.mouseMove(place.x, place.y);
    for (int click = 0; click < 2; ++click) {
      robot.mousePress(InputEvent.BUTTON1_DOWN_MASK);
      robot.mouseRelease(InputEvent.BUTTON1_DOWN_MASK);
    }
    robot.waitForIdle();
    Thread.sleep(500);
  }

  /** Windows of channels that moved under the mouse, because lcm-spy sorted in a new one. */
  private void closeOthers() {
    for (Frame frame : Frame.getFrames()) {
      if (frame.isVisible() && !opened.contains(frame.getTitle())) frame.setVisible(false);
    }
  }

  private int row(String channel) {
    for (int row = 0; row < channels.getRowCount(); ++row) {
      if (channel.equals(channels.getValueAt(row, 0))) return row;
    }
    return -1;
  }

  private void place(String title, int x, int y, int width, int height) throws Exception {
    onEventThread(() -> {
      frame(title).setBounds(x, y, width, height);
      frame(title).validate();
      return null;
    });
  }

  private Rectangle bounds(String title) throws Exception {
    return onEventThread(() -> frame(title).getBounds());
  }

  private void picture(String name, Rectangle area) throws Exception {
    robot.mouseMove(SCREEN.width - 5, SCREEN.height - 5);
    robot.waitForIdle();
    Thread.sleep(500);
    ImageIO.write(robot.createScreenCapture(area), "png", folder.resolve(name).toFile());
  }

  private void write(String name, List<List<Object>> rows) throws IOException {
    StringBuilder text = new StringBuilder();
    for (List<Object> row : rows) {
      for (int i = 0; i < row.size(); ++i) text.append(i == 0 ? "" : "\t").append(row.get(i));
      text.append('\n');
    }
    Files.writeString(folder.resolve(name + ".tsv"), text);
  }

  /** The names of the columns, then the rows. */
  private static List<List<Object>> rows(TableModel model) {
    List<List<Object>> rows = new ArrayList<>();
    rows.add(new ArrayList<>());
    for (int column = 0; column < model.getColumnCount(); ++column) rows.get(0).add(model.getColumnName(column));
    for (int row = 0; row < model.getRowCount(); ++row) {
      List<Object> values = new ArrayList<>();
      for (int column = 0; column < model.getColumnCount(); ++column) values.add(model.getValueAt(row, column));
      rows.add(values);
    }
    return rows;
  }

  private static Frame frame(String title) {
    for (Frame frame : Frame.getFrames()) {
      if (frame.isVisible() && title.equals(frame.getTitle())) return frame;
    }
    return null;
  }

  private static <T extends Component> T find(Class<T> type, Container container) {
    for (Component child : container.getComponents()) {
      if (type.isInstance(child)) return type.cast(child);
      T found = child instanceof Container ? find(type, (Container) child) : null;
      if (found != null) return found;
    }
    return null;
  }

  private static void await(String what, Callable<Boolean> holds) throws Exception {
    long end = System.currentTimeMillis() + PATIENCE_MS;
    while (!onEventThread(holds)) {
      if (System.currentTimeMillis() > end) throw new IllegalStateException("no " + what);
      Thread.sleep(100);
    }
  }

  private static <T> T onEventThread(Callable<T> action) throws Exception {
    FutureTask<T> task = new FutureTask<>(action);
    SwingUtilities.invokeLater(task);
    return task.get();
  }
}
