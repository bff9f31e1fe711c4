// plan_word.h — the plan in words, and whether it was kept.

#ifndef PLAN_WORD_H
#define PLAN_WORD_H

#include "plan.h"

typedef enum plan_verdict {
  PLAN_DONE,
  PLAN_REDUCED,
  PLAN_SKIPPED
} plan_verdict;

// What became of a stage, or will if it has not said yet what it did.
plan_verdict plan_verdict_of(const plan_line *l);

// Whether it did what was planned: exactly, or no more where need is a bound,
// and nothing where nothing was needed.
bool plan_kept(const plan_line *l);

// The names of a verdict, of a stage, and of what it counts.
const char *plan_word(plan_verdict verdict);
const char *plan_name(plan_stage stage);
const char *plan_unit(plan_stage stage);

#endif
