// cmd_signals.h — what other programs, and impatient people, ask of a run.

#ifndef CMD_SIGNALS_H
#define CMD_SIGNALS_H

#include <signal.h>

// Set by the first SIGINT or SIGTERM, and by every SIGUSR1.
extern volatile sig_atomic_t signal_stop, signal_snapshot;

// From now on SIGUSR1 sets signal_snapshot.
void signals_catch_snapshot(void);

// From now on the first SIGINT or SIGTERM sets signal_stop; a second one, of
// either kind, ends the program as it would have without this.
void signals_catch_stop(void);

#endif
