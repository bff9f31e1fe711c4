#include "stress.h"
void stress_twice(stress *s) {
  (void)s;
}
