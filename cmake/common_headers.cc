// SPDX-License-Identifier: BSD-3-Clause
// Compiled for its precompiled headers alone (options.cmake).
int main() { return 0; }
