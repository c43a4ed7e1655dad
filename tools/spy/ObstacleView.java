package scree.spy;

import java.awt.BasicStroke;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.event.ActionEvent;
import java.awt.geom.AffineTransform;
import java.awt.geom.Path2D;
import java.util.Locale;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;
import scree.obstacle_list_t;
import scree.obstacle_t;

/**
 * Plug-in of lcm-spy: draws the newest obstacle list of a channel from above, in the robot's frame,
 * forward is up. Opens at a double click on the channel. The mouse wheel changes the scale.
 */
public class ObstacleView implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == obstacle_list_t.LCM_FINGERPRINT;
  }

  /** lcm-spy asks once without desktop and channel, for the name. */
  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction("Obstacles from above") {
      @Override
      public void actionPerformed(ActionEvent event) {
        desktop.setLayout(new BorderLayout());
        desktop.add(new View(channel));
        SwingUtilities.getWindowAncestor(desktop).setSize(640, 700);
        desktop.revalidate();
      }
    };
  }

  private static class View extends JComponent {
    private static final Color ROCK = new Color(60, 110, 220), HOLE = new Color(220, 60, 50);
    private static final Color OLD = new Color(150, 150, 150), ROBOT = new Color(0, 120, 60);
    private static final double REACH = 30; // metres of the grid
    private static final double OLD_AFTER = 1; // seconds

    private final ChannelData channel;
    private double metre = 28; // pixels

    View(ChannelData channel) {
      this.channel = channel;
      setPreferredSize(new Dimension(640, 700));
      addMouseWheelListener(
          event -> {
            metre = Math.max(8, Math.min(120, metre * Math.pow(1.15, -event.getWheelRotation())));
            repaint();
          });
      Timer timer = new Timer(50, event -> repaint());
      addHierarchyListener(
          event -> {
            if (isShowing()) timer.start();
            else timer.stop();
          });
    }

    @Override
    protected void paintComponent(Graphics graphics) {
      Graphics2D page = (Graphics2D) graphics.create();
      page.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
      page.setColor(Color.WHITE);
      page.fillRect(0, 0, getWidth(), getHeight());
      // From metres in `base` (x forward, y left) to pixels.
      AffineTransform base = new AffineTransform();
      base.translate(getWidth() / 2.0, getHeight() * 0.75);
      base.scale(metre, metre);
      base.rotate(-Math.PI / 2);
      base.scale(1, -1);
      drawGrid(page, base);

      // As lcm-spy sets it: on this clock.
      double age = (System.nanoTime() / 1000 - channel.last_utime) * 1e-6;
      boolean isOld = age > OLD_AFTER;
      Object last = channel.last;
      int obstacles = 0;
      if (last instanceof obstacle_list_t) {
        obstacle_list_t list = (obstacle_list_t) last;
        obstacles = list.size;
        for (obstacle_t obstacle : list.obstacles) draw(page, base, list, obstacle, isOld);
      }
      page.setColor(isOld ? HOLE : Color.BLACK);
      String text = isOld ? "no list for %.0f s, the last had %d obstacles" : "%2$d obstacles (blue rocks, red holes), %1$.1f s ago";
      page.drawString(String.format(Locale.ROOT, text, age, obstacles), 8, 18);
    }

    private void drawGrid(Graphics2D page, AffineTransform base) {
      for (int i = (int) -REACH; i <= REACH; i++) {
        page.setColor(i % 5 == 0 ? new Color(190, 190, 190) : new Color(232, 232, 232));
        page.draw(path(base, false, i, -REACH, i, REACH));
        page.draw(path(base, false, -REACH, i, REACH, i));
      }
      page.setColor(Color.GRAY);
      for (int i = (int) -REACH; i <= REACH; i += 5) {
        double[] place = {i, 0};
        base.transform(place, 0, place, 0, 1);
        page.drawString(i + " m", (float) place[0] + 3, (float) place[1] - 3);
      }
      page.setColor(ROBOT);
      page.fill(path(base, true, 0.5, 0, -0.5, 0.35, -0.3, 0, -0.5, -0.35));
    }

    private void draw(
        Graphics2D page, AffineTransform base, obstacle_list_t list, obstacle_t box, boolean isOld) {
      double[][] outline = box.corners > 2 ? box.footprint : cornersOf(box);
      double[] corners = new double[2 * outline.length];
      for (int i = 0; i < outline.length; i++) {
        double[] corner = {outline[i][0], outline[i][1], box.center[2]};
        System.arraycopy(inBase(list, corner), 0, corners, 2 * i, 2);
      }
      Color kind = box.kind == obstacle_t.POSITIVE ? ROCK : HOLE;
      page.setColor(isOld ? OLD : kind);
      Path2D shape = path(base, true, corners);
      page.fill(shape);
      page.setStroke(new BasicStroke(1));
      page.draw(shape);
      page.setColor(Color.BLACK);
      page.drawString(
          String.format(Locale.ROOT, "#%d %.2f m", box.id, box.height),
          (float) shape.getBounds2D().getMaxX() + 3,
          (float) shape.getBounds2D().getCenterY() + 4);
    }

    /** x and y of the box's corners in `odom`. */
    private static double[][] cornersOf(obstacle_t box) {
      double cos = Math.cos(box.yaw), sin = Math.sin(box.yaw);
      double[][] corners = new double[4][];
      for (int i = 0; i < 4; i++) {
        double along = (i == 0 || i == 3 ? 0.5 : -0.5) * box.extent[0];
        double across = (i < 2 ? 0.5 : -0.5) * box.extent[1];
        corners[i] =
            new double[] {
              box.center[0] + cos * along - sin * across, box.center[1] + sin * along + cos * across
            };
      }
      return corners;
    }

    /** x and y in `base` of a place in `odom`: its offset from p, turned back by q (w, x, y, z). */
    private static double[] inBase(obstacle_list_t list, double[] place) {
      double w = list.q[0], x = list.q[1], y = list.q[2], z = list.q[3];
      double[] off = new double[3];
      for (int i = 0; i < 3; i++) off[i] = place[i] - list.p[i];
      return new double[] {
        (1 - 2 * (y * y + z * z)) * off[0] + 2 * (x * y + w * z) * off[1] + 2 * (x * z - w * y) * off[2],
        2 * (x * y - w * z) * off[0] + (1 - 2 * (x * x + z * z)) * off[1] + 2 * (y * z + w * x) * off[2]
      };
    }

    /** Through places in `base`: x and y in turns. */
    private static Path2D path(AffineTransform base, boolean isClosed, double... places) {
      Path2D path = new Path2D.Double();
      path.moveTo(places[0], places[1]);
      for (int i = 2; i < places.length; i += 2) path.lineTo(places[i], places[i + 1]);
      if (isClosed) path.closePath();
      path.transform(base);
      return path;
    }
  }
}
