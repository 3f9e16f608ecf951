package halocline.spy;

import halocline.link_table_t;
import java.awt.Dimension;
import javax.swing.Action;
import javax.swing.JComboBox;
import javax.swing.JDesktopPane;
import javax.swing.JTable;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** All LINKS.* as one matrix. lcm-spy finds this class in the jars of its class path and makes one of it. */
public final class LinksPlugin implements SpyPlugin {
  private static final Dimension SIZE = new Dimension(760, 300);

  private final Recorder recorder = Recorder.shared();

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == link_table_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return TableView.opening("Link matrix", desktop, SIZE, this::view);
  }

  private TableView view() {
    LinkMatrix matrix = new LinkMatrix(recorder.links);
    JTable table = new JTable(matrix);
    Cells cells = new Cells(matrix::share);
    table.setDefaultRenderer(Object.class, cells);
    JComboBox<LinkQuantity> choice = new JComboBox<>();
    for (LinkQuantity quantity : LinkQuantity.all()) {
      choice.addItem(quantity);
      if (quantity.name().equals(matrix.quantity().name())) choice.setSelectedItem(quantity);
    }
    choice.setMaximumRowCount(LinkQuantity.all().size());
    choice.addActionListener(event -> matrix.choose((LinkQuantity) choice.getSelectedItem()));
    return new TableView(matrix, table, choice);
  }
}
