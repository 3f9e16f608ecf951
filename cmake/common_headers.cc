// Compiled for its precompiled headers alone (options.cmake).
int main() { return 0; }
