#include "engine/load/load.h"
int main() { return 0; }
