// cmd_signals.c — the two variables of the program that change and belong to
// nobody: a signal handler has no argument through which to reach others.

#include "cmd_signals.h"

#include <stddef.h>

volatile sig_atomic_t signal_stop;
volatile sig_atomic_t signal_snapshot;

// The second signal finds signal_stop set and is sent again with its default
// action, so that the parent sees which signal it was (128 + n in a shell).
static void on_stop(int number) {
  if (signal_stop) {
    signal(number, SIG_DFL);
    raise(number);
  }
  signal_stop = 1;
}

static void on_snapshot(int number) {
  (void)number;
  signal_snapshot = 1;
}

// SA_RESTART: a read or write under way goes on as if nothing had happened.
static void catch_signal(int number, void (*handler)(int)) {
  struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL);
}

void signals_catch_snapshot(void) {
  catch_signal(SIGUSR1, on_snapshot);
}

void signals_catch_stop(void) {
  struct sigaction old;
  const int numbers[] = {SIGINT, SIGTERM};
  for (size_t i = 0; i < 2; i++) {
    // What the parent had ignored (nohup, a shell's &) stays ignored.
    sigaction(numbers[i], NULL, &old);
    if (old.sa_handler != SIG_IGN) catch_signal(numbers[i], on_stop);
  }
}
