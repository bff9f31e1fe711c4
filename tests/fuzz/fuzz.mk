# Readers of strangers' files under libFuzzer (clang-14, libclang-rt-14-dev):
#   make fuzz SECONDS=300    each target in turn so long, all cores at a time
#   make fuzz-afl SECONDS=60 the same inputs under AFL++ (afl++)
#   make hostile             the unit test and the table, with two sanitizers
# A finding is left in build/fuzz/; with a name it goes to tests/fuzz/corpus,
# which tests/test_hostile.c reads ever after.

FUZZ         := obj mtl scene hdr pfm png jpeg tga option script part
FUZZ_MODULES := $(CHAPTER_3) rng post view_state view_script option_table option \
                bytes digest part part_read shard film
SECONDS      ?= 300
FUZZ_SAN     := -fsanitize=address,undefined -fno-sanitize-recover=all

fuzz-build:
	$(MAKE) --no-print-directory VARIANT=fuzz CC=clang-14 \
	  CFLAGS="-O1 -g -fno-omit-frame-pointer -fsanitize=fuzzer-no-link $(FUZZ_SAN)" \
	  $(FUZZ:%=build/fuzz/fuzz_%)
build/fuzz/fuzz_%: tests/fuzz/fuzz.c tests/fuzz/targets.h $(call obj,$(FUZZ_MODULES))
	$(CC) $(FLAGS) $(CFLAGS) -fsanitize=fuzzer -DTARGET=target_$* \
	  $(filter-out %.h,$^) $(LIBS) -o $@
fuzz: fuzz-build
	tests/fuzz/run $(SECONDS) $(FUZZ)

afl-build:
	$(MAKE) --no-print-directory VARIANT=afl CC=afl-clang-fast \
	  CFLAGS="-O1 -g $(FUZZ_SAN)" $(FUZZ:%=build/afl/afl_%)
build/afl/afl_%: tests/fuzz/fuzz.c tests/fuzz/targets.h $(call obj,$(FUZZ_MODULES))
	$(CC) $(FLAGS) $(CFLAGS) -fsanitize=fuzzer -DTARGET=target_$* \
	  $(filter-out %.h,$^) $(LIBS) -o $@
fuzz-afl: afl-build
	tests/fuzz/run-afl $(SECONDS) $(FUZZ)

# Every length and 10,000 changes of each format, and the table of hostile
# files, with two sanitizers.
hostile:
	$(MAKE) --no-print-directory SAN=address,undefined \
	  build/address-undefined/facet build/address-undefined/tests/test_hostile
	build/address-undefined/tests/test_hostile
	LSAN_OPTIONS=suppressions=$(CURDIR)/tests/leaks.supp:print_suppressions=0 \
	  FACET=build/address-undefined/facet tests/hostile.t

.PHONY: hostile fuzz fuzz-build fuzz-afl afl-build
