# make               build/facet, the renderer
# make chapter-4     the pictures of chapter 4, each compared with the book's
# make figures       those of all chapters
# make bless-4       accept chapter 4's new pictures as the book's (look first)
# make test          every test; ends in prove's summary
# make sanitize      tests under ASan, UBSan, TSan, valgrind
# make agree         the same bytes from gcc and clang, -O0 to -O3
# make stress        numbers at their limits, as a table (chapter 16)
# make bench         measurements that depend on the machine
# make fuzz          strange files for every reader, SECONDS (300) each
# make weave         refresh the listings of the chapters from the source
# make book          the HTML book, build/book/index.html
# make format        lay out the source with clang-format 14
# make install       program, manual, completions, scenes: PREFIX (/usr/local), DESTDIR
# make uninstall     remove them again
# make deb           build/deb/*.deb, by Debian's tools (needs debhelper)
# make clean         remove build/

CC      ?= cc
CFLAGS  ?= -O2 -g
PREFIX  ?= /usr/local
WARN    := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion \
           -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
# No -ffast-math and no contraction: one source, one image, on every machine.
FLAGS   := -std=c11 -D_POSIX_C_SOURCE=200809L $(WARN) -ffp-contract=off -iquote src
LIBS    := -lpng -ljpeg -lm -lpthread -ldl
# make SAN=address,undefined puts a second build beside the first.
comma   := ,
B       := build/$(or $(subst $(comma),-,$(SAN)),$(VARIANT),release)
ifdef SAN
FLAGS   += -fsanitize=$(SAN) -fno-omit-frame-pointer -fno-sanitize-recover=all
endif

# The floors of src/, ground first: also the reading order of the book.  A
# module includes only modules on its left or above (tests/floors.t), and the
# program of a chapter links only the modules that it and the chapters before
# it explain: the linker proves the reading order.
CHAPTER_1 := scalar vec error arena report file image png pfm hdr jpeg tga picture picture_head metric
CHAPTER_2 := $(CHAPTER_1) cpu_quota clock pool number text path_find polygon \
             mesh name_table mtl_map mtl mtl_read obj_source obj_corner \
             pages obj_chunk obj_line obj_parse obj_pack obj_merge obj_events obj normals
CHAPTER_3 := $(CHAPTER_2) num ray triangle camera texture env material \
             statement scene_file mesh_join material_list scene scene_text
CHAPTER_4 := $(CHAPTER_3) aabb slab bvh sah_box sah bvh_part bvh_read bvh_build rays rays_make
CHAPTER_5 := $(CHAPTER_4) gl_api gl gl_make glsl raster_settings raster_block raster_mesh \
             raster_maps raster_program raster_seen raster_shadow raster_view raster_stock \
             raster_pass raster_once raster
CHAPTER_6 := $(CHAPTER_5) microfacet dfg bsdf_rough raster_rough
CHAPTER_7 := $(CHAPTER_6) ibl_level ibl_lobe ibl_wave ibl_source ibl_methods \
             cache_folder cache ibl_cache ibl raster_env
CHAPTER_8 := $(CHAPTER_7) surface surface_ray surface_normal
CHAPTER_9 := $(CHAPTER_8) rng bsdf matter path_world vertex roulette path_naive film shard tally first_hit render_guide render_sums \
             render_keep render
CHAPTER_10 := $(CHAPTER_9) tracer sobol sampler pick light_env light_triangle \
              light_bound light_tree light_tree_build light_part light_sky light_lore light_memory \
              light_emission light lanes path_plain path_ready path_sky aim path_aim path_log path_group path_share path_tracer path_wave path path_learn share_learn \
              aim_photon aim_build aim_learn
CHAPTER_11 := $(CHAPTER_10) lean raster_lean
CHAPTER_12 := $(CHAPTER_11) simd_base simd_avx2 simd simd_lanes simd_runs \
             build_lanes build_bins build_cut build_move build_split build_levels build_avx2 build bvh_split_clip bvh_split_bins bvh_split_part bvh_split wide_cost bvh_bundle bvh_shared \
             simd_squeeze wide_tree wide_faces wide_above wide_below wide_levels wide_box wide_columns wide_ready wide_packet wide_edges wide_tests wide_distance wide_leaf wide_single wide_push \
             wide_alike wide_gather wide_interval wide_packet_leaf \
             wide_descent wide_flight wide_pending wide_steps wide_start wide_stream wide_crowd wide_crowd_ready wide_part wide_crowd_settle wide_crowd_leaf wide_together wide_few wide_few_ready wide_few_leaf wide_few_all wide_kernel wide_base wide_avx2 wide_avx512 wide wide_patch \
             vertex_lanes vertex_lanes_facet vertex_lanes_smooth vertex_lanes_find \
             ready_levels ready_work ready_numbers ready_starts ready_num ready_keys ready_leaf ready_pick ready_triangle ready_leave ready_clear \
             ready_sky ready_sky_kinds ready_sky_list ready_sky_way ready_sky_ask ready_sky_view ready_sky_rival ready_sky_look ready_lane ready_kernel ready_base ready_avx2 ready_avx512 ready
CHAPTER_13 := $(CHAPTER_12) plan_sight plan plan_word plan_use tree_cache
CHAPTER_14 := $(CHAPTER_13) post view_state view_script view_paths view_window
CHAPTER_15 := $(CHAPTER_14) glyph sketch plot two_means halves jury adaptive doubling
CHAPTER_16 := $(CHAPTER_15) bytes digest scene_digest part part_read part_set
LIBRARY   := $(CHAPTER_16)
CHAPTERS  := 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17
# The command line, the only floor that prints and exits.
COMMAND   := json tonemap progress option_id option_table option cmd_shared cmd_signals \
             cmd_output cmd_tree cmd_shot cmd_plan cmd_forced cmd_raster cmd_keep cmd_render_say cmd_render_plan cmd_render cmd_merge cmd_view_say cmd_view cmd_info_scene \
             cmd_info_part cmd_info cmd_compare cmd_bench cmd_bench_raster cmd_ibl cmd_bench_ibl cmd_cache \
             cmd_child cmd_error_run cmd_bench_error \
             help_text cmd_manual cmd_completion cmd_help main
MODULES   := $(LIBRARY) $(COMMAND)
CHAPTER_17 := $(filter-out main,$(MODULES))

# Objects of those modules that have a .c; the folder of chapter N.
# Whoever assembles shaders links their text.
obj  = $(patsubst src/%.c,$(B)/src/%.o,$(wildcard $(1:%=src/%.c))) \
       $(if $(filter glsl,$(1)),$(B)/shaders.o) \
       $(if $(filter cmd_keep,$(1)),$(B)/source.o)
slug = $(notdir $(wildcard chapters/$(shell printf %02d $(1))-*))

all: build/facet

ifeq ($(B),build/release)
build/facet: $(B)/facet
	ln -f $< $@
endif

$(B)/facet: $(call obj,$(MODULES))
	$(CC) $(FLAGS) $(CFLAGS) $(LDFLAGS) $^ $(LIBS) -o $@

$(B)/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(FLAGS) $(CFLAGS) $(LOOPS) -MMD -MP -c $< -o $@

# One kernel (src/wide_kernel.h) for several sets of instructions; the program
# asks the processor which it has.
ifneq (,$(findstring x86_64,$(shell $(CC) -dumpmachine)))
AVX2 := -mavx2 -mfma -mbmi -mbmi2
$(B)/src/build_avx2.o $(B)/src/wide_avx2.o $(B)/src/ready_avx2.o: FLAGS += $(AVX2)
$(B)/src/wide_avx512.o $(B)/src/ready_avx512.o: FLAGS += $(AVX2) -mavx512f -mavx512vl -mavx512dq -mavx512bw
endif

# Loops over lanes become vector instructions where nothing else is asked of
# them: errno and traps.  Not where sanitizers watch, whose checks are in the way.
ifndef SAN
QUICK_LOOPS := -O3 -fno-math-errno -fno-trapping-math
$(B)/src/ready_%.o: LOOPS := $(QUICK_LOOPS)
$(addprefix $(B)/src/,two_means.o doubling.o pick.o light_env.o light_lore.o light_memory.o): LOOPS := $(QUICK_LOOPS)
endif

# The files of shaders/ as one table of names and texts (src/glsl.h).
SHADERS := $(wildcard shaders/*.glsl shaders/*.vert shaders/*.frag)
$(B)/shaders.c: shaders/embed.sh $(SHADERS)
	@mkdir -p $(@D)
	sh shaders/embed.sh $(SHADERS) >$@
$(B)/shaders.o: $(B)/shaders.c
	$(CC) $(FLAGS) $(CFLAGS) -c $< -o $@

# A sum over all sources, which parts of pictures are marked with.
$(B)/source.c: $(sort $(wildcard src/*.[ch]))
	@mkdir -p $(@D)
	cat $^ | cksum | sed 's/\(.*\) .*/extern const char source_sum[];const char source_sum[] = "\1";/' >$@
$(B)/source.o: $(B)/source.c
	$(CC) $(FLAGS) $(CFLAGS) -c $< -o $@

# A chapter's program writes its pictures into the folder that it is given.
define chapter_rules
$(B)/chapter-$(1): $(B)/chapters/$(call slug,$(1))/figures.o \
                   $(call obj,$(CHAPTER_$(1)))
	$$(CC) $$(FLAGS) $$(CFLAGS) $$^ $$(LIBS) -o $$@
draw-$(1): $(B)/chapter-$(1)
	@rm -rf build/figures/$(call slug,$(1))
	@mkdir -p build/figures/$(call slug,$(1))
	$(B)/chapter-$(1) build/figures/$(call slug,$(1))
chapter-$(1): draw-$(1) build/facet
	@tests/figures.sh $(call slug,$(1))
bless-$(1): draw-$(1)
	@mkdir -p chapters/$(call slug,$(1))/images
	cp build/figures/$(call slug,$(1))/*.png chapters/$(call slug,$(1))/images/
endef
$(foreach n,$(CHAPTERS),$(eval $(call chapter_rules,$(n))))

figures: $(CHAPTERS:%=chapter-%)

weave:
	python3 chapters/weave.py update

# Unit tests are cmocka programs, one per tests/test_*.c, linked with all but
# main; the rest are shell scripts.  All print TAP.
UNIT := $(patsubst tests/%.c,$(B)/tests/%,$(wildcard tests/test_*.c))
$(UNIT): $(B)/tests/%: $(B)/tests/%.o $(call obj,$(filter-out main,$(MODULES)))
	$(CC) $(FLAGS) $(CFLAGS) $^ -lcmocka $(LIBS) -o $@
.PRECIOUS: $(B)/tests/%.o

unit: $(UNIT)
build-tests: all unit $(B)/stress $(CHAPTERS:%=$(B)/chapter-%)
test: build-tests
	+$(MAKE) --no-print-directory SAN=address,undefined \
	  build/address-undefined/facet unit
	CMOCKA_MESSAGE_OUTPUT=TAP MODULES="$(MODULES)" CC="$(CC)" \
	  CHAPTERS="$(CHAPTERS)" prove --timer -j 2 -e '' tests/*.t $(UNIT)

# What was tried hard, how often, and what broke: a table.  STRESS=long takes
# hours, "short" seconds; a number behind it changes the random numbers.
STRESS ?= full
$(B)/stress: $(patsubst %.c,$(B)/%.o,$(filter-out %/kernel.c,$(wildcard tests/stress/*.c))) \
             $(B)/kernel_float.o $(B)/kernel_double.o \
             $(call obj,$(filter-out main,$(MODULES)))
	$(CC) $(FLAGS) $(CFLAGS) $^ -lcmocka $(LIBS) -o $@
# The same code with float and with double; each keeps but one name.
$(B)/kernel_float.o: KERNEL := kernel_float
$(B)/kernel_double.o: KERNEL := kernel_double -DKERNEL_DOUBLE
$(B)/kernel_float.o $(B)/kernel_double.o: $(B)/kernel_%.o: tests/stress/kernel.c Makefile
	@mkdir -p $(@D)
	$(CC) $(FLAGS) $(CFLAGS) $(wordlist 2,9,$(KERNEL)) -MMD -MP -c $< -o $@
	objcopy --keep-global-symbol=$(firstword $(KERNEL)) $@
stress: $(B)/stress
	$(B)/stress $(STRESS)

# The suite and some scripts under the sanitizers, a picture under valgrind;
# pictures by gcc and clang, with and without optimisation, byte for byte.
# Longer than `make test`.
SANITIZED := build/address-undefined build/thread
sanitize: all
	+for s in address,undefined thread; do \
	  $(MAKE) --no-print-directory SAN=$$s \
	    build/$$(echo $$s | tr , -)/facet unit || exit; done
	tests/sanitize.sh $(SANITIZED)
agree: all
	+$(MAKE) --no-print-directory VARIANT=O0 CFLAGS=-O0 build/O0/facet
	+$(MAKE) --no-print-directory VARIANT=clang CC=clang-14 build/clang/facet
	+$(MAKE) --no-print-directory VARIANT=clang-O3 CC=clang-14 CFLAGS=-O3 build/clang-O3/facet
	tests/agree.sh build/release/facet build/O0/facet build/clang/facet build/clang-O3/facet

bench: all
	tests/bench/run

include tests/fuzz/fuzz.mk

BOOK := $(patsubst chapters/%/README.md,build/book/%.html,\
          $(wildcard chapters/*/README.md)) \
        build/book/index.html build/book/references.html
book: $(BOOK)
build/book/index.tsv: $(wildcard chapters/*/README.md) $(wildcard src/*.[ch]) \
                      chapters/weave.py
	@mkdir -p $(@D)
	python3 chapters/weave.py index > $@
build/book/index.html: chapters/README.md
	$(call pandoc,index)
build/book/references.html: chapters/references.md
	$(call pandoc,references)
build/book/%.html: chapters/%/README.md
	@mkdir -p build/book/$*-images
	cp chapters/$*/images/* build/book/$*-images/
	$(call pandoc,$*)
$(BOOK): chapters/book.lua chapters/book.css build/book/index.tsv
pandoc = pandoc -f gfm+footnotes -t html5 --mathml -s \
  -M index=build/book/index.tsv -M chapter=$(1) -M pagetitle=facet \
  --css book.css --lua-filter chapters/book.lua $< -o $@ && \
  cp chapters/book.css build/book/

format:
	clang-format-14 -i src/*.[ch] tests/*.[ch] chapters/*.h chapters/*/figures.c

# The manual pages are those that help can print.
ROOT     = $(DESTDIR)$(PREFIX)
BASHDIR ?= $(PREFIX)/share/bash-completion/completions
ZSHDIR  ?= $(PREFIX)/share/zsh/site-functions
FISHDIR ?= $(PREFIX)/share/fish/vendor_completions.d
COMMANDS = build/facet help | sed -n 's/^  facet \(\([a-z]\+ \)\+\)[A-Z[].*/\1/p'
install: all
	install -D build/facet "$(ROOT)/bin/facet"
	install -d "$(ROOT)/share/facet/scenes" "$(ROOT)/share/man/man1" \
	  "$(DESTDIR)$(BASHDIR)" "$(DESTDIR)$(ZSHDIR)" "$(DESTDIR)$(FISHDIR)"
	install -m 644 scenes/*.* "$(ROOT)/share/facet/scenes"
	build/facet help --man >"$(ROOT)/share/man/man1/facet.1"
	$(COMMANDS) | while read -r c; do build/facet help --man $$c \
	  >"$(ROOT)/share/man/man1/facet-$$(echo $$c | tr ' ' -).1" || exit; done
	build/facet help --completion bash >"$(DESTDIR)$(BASHDIR)/facet"
	build/facet help --completion zsh >"$(DESTDIR)$(ZSHDIR)/_facet"
	build/facet help --completion fish >"$(DESTDIR)$(FISHDIR)/facet.fish"

uninstall: all
	$(COMMANDS) | while read -r c; do \
	  rm -f "$(ROOT)/share/man/man1/facet-$$(echo $$c | tr ' ' -).1"; done
	rm -f "$(ROOT)/bin/facet" "$(ROOT)/share/man/man1/facet.1" \
	  "$(DESTDIR)$(BASHDIR)/facet" "$(DESTDIR)$(ZSHDIR)/_facet" \
	  "$(DESTDIR)$(FISHDIR)/facet.fish"
	rm -rf "$(ROOT)/share/facet"

deb:
	rm -rf build/deb
	mkdir -p build/deb/facet
	tar -c --exclude=./build --exclude=./.git . | tar -x -C build/deb/facet
	cd build/deb/facet && dpkg-buildpackage -us -uc -b
	rm -rf build/deb/facet

clean:
	rm -rf build

.PHONY: all figures weave unit build-tests test stress sanitize agree bench book format install uninstall deb clean \
        $(foreach n,$(CHAPTERS),draw-$(n) chapter-$(n) bless-$(n))
-include $(shell find build -name '*.d' 2>/dev/null)
