// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import java.util.Locale;
import java.util.Map;

/** Names and numbers as a person reads them. */
final class Texts {
  private static final Map<String, String> UNITS = Map.of("db", "dB", "s", "s", "m", "m", "hz", "Hz", "bps", "bit/s");

  private Texts() {}

  /** "delay_spread_s" is "delay spread, s". */
  static String label(String field) {
    int last = field.lastIndexOf('_');
    String unit = last < 0 ? null : UNITS.get(field.substring(last + 1));
    String text = words(unit == null ? field : field.substring(0, last)).replace("sinr", "SINR").replace("snr", "SNR");
    return unit == null ? text : text + ", " + unit;
  }

  /** "TOO_STEEP" is "too steep". */
  static String words(String identifier) {
    return identifier.toLowerCase(Locale.ROOT).replace('_', ' ');
  }

  /** Four digits or so; large numbers whole, and nothing of less than 1e-12. */
  static String number(double value) {
    double size = Math.abs(value);
    return String.format(Locale.ROOT, format(size), value);
  }

  private static String format(double size) {
    if (size >= 1e6 || size < 1e-3 && size > 1e-12) return "%.1e";
    return size > 100 ? size > 1000 ? "%.0f" : "%.1f" : size > 1 ? "%.2f" : "%.3f";
  }

  static String seconds(long utime) {
    return String.format(Locale.ROOT, "%.3f", 1e-6 * utime);
  }
}
