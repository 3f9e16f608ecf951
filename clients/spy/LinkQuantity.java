// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

import halocline.link_t;
import java.lang.reflect.Field;
import java.lang.reflect.Modifier;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;

/** A column of a link table: any field of link_t but the two ids, so that new fields appear without a change here. */
final class LinkQuantity {
  private static final Map<String, String> CODES =
      Map.of("multipath", "MULTIPATH_", "path_state", "PATH_", "propagation_used", "USED_");

  private final Field field;

  private LinkQuantity(Field field) {
    this.field = field;
  }

  /** In the order of link_t.lcm. */
  static List<LinkQuantity> all() {
    List<LinkQuantity> quantities = new ArrayList<>();
    for (Field field : link_t.class.getFields()) {
      if (!Modifier.isStatic(field.getModifiers()) && !field.getName().endsWith("_id")) quantities.add(new LinkQuantity(field));
    }
    return quantities;
  }

  static LinkQuantity named(String name) {
    for (LinkQuantity quantity : all()) {
      if (quantity.name().equals(name)) return quantity;
    }
    throw new IllegalArgumentException("link_t has no field " + name);
  }

  String name() {
    return field.getName();
  }

  /** Words and unit. */
  @Override
  public String toString() {
    return Texts.label(name());
  }

  boolean isProbability() {
    return name().endsWith("_probability") || name().startsWith("delivery_");
  }

  /** A Double, or the words of a code or of yes and no. */
  Object value(link_t link) {
    try {
      Object value = field.get(link);
      if (value instanceof Boolean) return (Boolean) value ? "yes" : "no";
      if (CODES.containsKey(name())) return code(((Number) value).byteValue());
      return ((Number) value).doubleValue();
    } catch (IllegalAccessException impossible) {
      throw new AssertionError(impossible);
    }
  }

  private String code(byte value) throws IllegalAccessException {
    String prefix = CODES.get(name());
    for (Field constant : link_t.class.getFields()) {
      if (Modifier.isStatic(constant.getModifiers()) && constant.getName().startsWith(prefix) && constant.getByte(null) == value) {
        return Texts.words(constant.getName().substring(prefix.length()));
      }
    }
    return Byte.toString(value);
  }
}
