// SPDX-License-Identifier: BSD-3-Clause
package halocline.spy;

/** View that is redrawn a few times a second, however fast messages come. */
interface Refreshed {
  void refresh();

  /** One line beside the table. */
  String status();
}
