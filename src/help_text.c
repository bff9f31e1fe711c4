// help_text.c

#include "help_text.h"

#include <stddef.h>

const help_group help_groups[] = {
    {OPT_OUTPUT, "Output"},
    {OPT_ENGINE, "Engine and models"},
    {OPT_CAMERA, "Camera"},
    {OPT_ENV, "Light"},
    {OPT_MSAA, "Surfaces"},
    {OPT_SPP, "Samples and paths"},
    {OPT_EXPOSURE, "From light to screen"},
    {OPT_SCRIPT, "Script and scene"},
    {OPT_METRIC, "Comparison"},
    {OPT_KIND, "Measurement"},
    {OPT_MAN, "General"},
    {OPTION_COUNT, NULL},
};

const help_example help_examples[] = {
    {CMD_RENDER, "facet render teapot.obj",
     "the teapot, framed and lit by a sky, as teapot.png"},
    {CMD_RENDER, "facet render garden.scene --engine path --spp 256 -o a.png",
     "the same by the paths of light, 256 for each pixel"},
    {CMD_RENDER, "facet render garden.obj --engine path --time 60 -o a.png",
     "the best picture that a minute gives"},
    {CMD_RENDER, "facet render garden.obj --engine path --error 0.01 -o a.pfm",
     "until the estimated error is below one per cent; linear light"},
    {CMD_RENDER,
     "facet render car.obj --env sky.hdr --env-rotate 90 -o car.png",
     "under the sky of an HDR picture, turned"},
    {CMD_RENDER, "facet render a.obj -q -o - --format png",
     "to standard output, for the next program of a pipe"},
    {CMD_RENDER,
     "facet render a.obj --engine path --spp 4096 --checkpoint a.part --resume",
     "hours, in as many sittings as it takes"},
    {CMD_RENDER, "facet render a.obj --engine path --shard 3/8",
     "an eighth of the picture, for facet merge: a.3-of-8.part"},
    {CMD_MERGE, "facet merge a.*.part -o a.png",
     "the eight of them, the bytes of a single run"},
    {CMD_VIEW, "facet view garden.scene", "fly through the garden"},
    {CMD_VIEW, "facet view garden.scene --script tour.txt",
     "the same keys again, without a window"},
    {CMD_INFO, "facet info teapot.obj",
     "counts and bounds, and why each material is what it is"},
    {CMD_INFO, "facet info --scene teapot.obj",
     "a complete scene file to start from"},
    {CMD_COMPARE, "facet compare new.png old.png --fail 0.01 --diff d.png",
     "exit status 1 where they differ by more, and where, as a picture"},
    {CMD_BENCH_LOAD, "facet bench load city.obj", "where the time goes"},
    {CMD_BENCH_RAYS, "facet bench rays city.obj --kind bounce -j 1",
     "rays a second on one thread, as paths send them"},
    {CMD_BENCH_RASTER, "facet bench raster garden.scene --frames 100",
     "milliseconds a frame at three sizes"},
    {CMD_BENCH_ERROR, "facet bench error garden.scene --spp 1,4,16 -o plot.svg",
     "error against seconds, drawn"},
    {CMD_IBL, "facet ibl sky.hdr -o sky",
     "irradiance and blurred radiance as files, for another renderer"},
    {CMD_BENCH_IBL, "facet bench ibl sky.hdr", "how fast and how exact"},
    {CMD_CACHE, "facet cache", "what is kept, how large it is and for what"},
    {CMD_CACHE, "facet cache clear", "away with it"},
    {CMD_HELP, "facet help render", "the options of render"},
    {CMD_HELP, "facet help --man render", "its manual page"},
    {CMD_HELP, "facet help --completion bash",
     "what makes the shell complete options and their words"},
    {0, NULL, NULL},
};

const help_item help_items[] = {
    {"EXIT STATUS", "0", "done"},
    {NULL, "1",
     "finished, but the answer is no: pictures differ, parts do not fit, a "
     "warning under --strict"},
    {NULL, "2", "the command line is wrong"},
    {NULL, "3", "input is missing or malformed"},
    {NULL, "4", "output could not be written"},
    {NULL, "5", "out of memory, or no OpenGL for the raster engine"},
    {NULL, "75",
     "stopped early; what there was is written, or a checkpoint to go on from "
     "with --resume"},
    {NULL, "128+n", "ended by signal n"},
    {"SIGNALS", "SIGINT, SIGTERM",
     "The first finishes the pass, writes the checkpoint, or where there is "
     "none the picture so far, and exits with 75; the second ends the program "
     "at once."},
    {NULL, "SIGUSR1", "Writes the picture so far and goes on."},
    {NULL, "SIGPIPE",
     "Is ignored: a reader that leaves is an output that could not be "
     "written."},
    {NULL, "SIGXFSZ",
     "Is ignored: a file beyond ulimit -f is one that could not be written."},
    {"FILES", "NAME.scene",
     "Read with NAME.obj: cameras, lights, environment, film, materials."},
    {NULL, "XDG_CACHE_HOME/facet, ~/.cache/facet",
     "Sums over environments and trees over meshes, kept for the next run; "
     "safe to remove, as facet cache clear does."},
    {NULL, "PREFIX/share/facet/scenes", "Scenes to start with."},
    {"ENVIRONMENT", "NO_COLOR, TERM=dumb", "No colours, no progress bar."},
    {NULL, "COLUMNS", "The width of the progress bar's line."},
    {NULL, "SLURM_CPUS_PER_TASK",
     "Limits the threads, as the CPU affinity and the cgroup's quota do."},
    {NULL, "LP_NUM_THREADS",
     "The threads with which Mesa's software renderer draws; facet's number "
     "where it is not set."},
    {NULL, "FACET_CACHE_MIB",
     "The most that is kept in that folder, 256 where it is not set; 0: "
     "nothing."},
    {NULL, "TMPDIR", "Where bench error keeps the pictures that it compares."},
    {"LIMITS", "Meshes",
     "Fewer than 2^31 vertices, normals, texture coordinates and triangles."},
    {NULL, "Pictures",
     "Sides of 1 to 65535 pixels; of a file at most 1032 pixels for each byte, "
     "or 16777216 in all."},
    {NULL, "Scene files",
     "4096 mesh, camera and newmtl statements, 512 assign, 65536 light; a film "
     "of 67108864 pixels, and more only by --resolution."},
    {NULL, "Names",
     "What the files of a scene name lies in the folder of SCENE or below, all "
     "links followed, but with --allow-outside.  1000 names that lead nowhere "
     "are looked for in other cases of letters, the rest only as they stand."},
    {NULL, "Kinds of files",
     "Regular files only are read: no pipes, devices, sockets, folders.  SCENE "
     "may be standard input."},
    {NULL, "Memory",
     "What a stranger's file can make facet hold while it reads: 256 bytes for "
     "each byte of text, 14000 for each byte of a picture, and 256 MB.  A mesh "
     "counts as often as a scene names it."},
    {NULL, "Samples", "1 to 16777216 a pixel."},
    {NULL, "Threads", "1 to 1024."},
    {NULL, NULL, NULL},
};
