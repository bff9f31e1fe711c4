// option_table.c

#include "option_table.h"

#include <stddef.h>

// The commands that make pictures of a scene, and those that draw it at all.
enum { SHOWS = CMD_RENDER | CMD_BENCH_ERROR };
enum { DRAWS = SHOWS | CMD_VIEW | CMD_BENCH_RASTER };

const command command_table[] = {
    {"render", CMD_RENDER, "SCENE", 1, 1, "make one picture",
     "SCENE is an .obj, a .scene, or - for an OBJ on standard input.  A .scene "
     "file of the same stem beside an .obj is read with it.  With no option "
     "at all the picture is SCENE.png in the current folder: framed from the "
     "bounding box, lit by a built-in sky.\n"
     "The output is written beside its target and renamed: a failed run "
     "leaves an old picture as it was.  The first SIGINT or SIGTERM finishes "
     "the pass, writes the picture so far and exits with 75; the second ends "
     "the program at once.  SIGUSR1 writes the picture so far and goes on.\n"
     "With --checkpoint the path engine saves all sums now and then; the first "
     "signal saves them instead of a picture, and exits with 75.  The same "
     "command with --resume goes on from there, whatever has ended the run, "
     "and "
     "the picture is the one that it would have been, byte for byte.  A "
     "checkpoint of another scene, of other settings or of another version is "
     "refused with status 3.  --spp, --time and --error may be others: --spp "
     "is "
     "the total.\n"
     "With --shard I/N a run renders every N-th tile of 16x16 pixels of the "
     "path engine's picture and writes a .part; facet merge makes the picture "
     "of all N, the same one again.  Checkpoints and parts are files of one "
     "kind: a part can be gone on with, too."},
    {"merge", CMD_MERGE, "PART...", 1, 1000000, "make a picture of its parts",
     "The parts are what facet render --shard I/N has written, or -o FILE.part "
     "without it.  The picture and its AOVs equal those of a single run byte "
     "for byte.  Exit status 1, and nothing is written, when parts are of "
     "different pictures, not finished, missing or there twice: they are "
     "listed.  3 when one cannot be read or is damaged."},
    {"view", CMD_VIEW, "SCENE", 1, 1, "fly through a scene",
     "SCENE is as for render.  The mouse turns; w and s or the arrows up and "
     "down fly forward and back, a and d or left and right sideways, q and z "
     "up and down.  Shift puts frosted glass before the picture.  1 and 2 make "
     "metal-rough surfaces less and more metallic, 3 and 4 less and more "
     "rough; 0 shows them only, and all again.  Space turns to the path "
     "tracer, which refines while the camera rests, and back.  p prints the "
     "facet render line for the view, F12 saves SCENE-1.png, h prints the "
     "keys, Escape leaves.\n"
     "The window needs libglfw3 and a display; --script needs neither.  Names "
     "of keys in a script: w s a d q z up down left right shift 1 2 3 4 0 "
     "space p f12 h esc."},
    {"info", CMD_INFO, "FILE...", 1, 1000000, "say what a file holds",
     "FILE is an .obj, a .scene, a picture, a .part, or - for an OBJ on "
     "standard input.  For meshes and scenes: counts, bounds, area, and for "
     "each "
     "material the rule that decided how it is shaded."},
    {"compare", CMD_COMPARE, "A B", 2, 2, "compare picture A with reference B",
     "PNG, JPEG and TGA files are compared as they are stored, divided by "
     "their largest value; PFM and HDR files as linear light; where one of "
     "each is given, the first kind is decoded to linear.  All metrics are "
     "printed; the one named by --metric decides: exit status 0 when it is "
     "within --fail, 1 when not or when a pixel is not a number, 2 when the "
     "sizes differ."},
    {"bench load", CMD_BENCH_LOAD, "OBJ", 1, 1, "time the reading of an OBJ",
     "Seconds and MB of text per second for each stage, the median of "
     "--repeat runs."},
    {"bench rays", CMD_BENCH_RAYS, "OBJ", 1, 1, "time the tracing of rays",
     "Rays are made for the mesh (--kind) or read from a file.  A ray file "
     "holds, little-endian, \"RAYS\", u32 flags (1: any hit will do), u64 "
     "count, and for each ray 8 floats: origin, tmin, direction, tmax.  A hit "
     "file holds \"HITS\", flags, count, and for each ray a float t and an i32 "
     "triangle in OBJ order, -1 for a miss, whose t is tmax; where any hit "
     "will do, t is tmax and the triangle 0 for a hit."},
    {"bench raster", CMD_BENCH_RASTER, "SCENE", 1, 1, "time the raster engine",
     "For each size, --frames frames of the scene without its sky, one after "
     "another, until the last is finished: by the clock, and in milliseconds "
     "of processors at work (work ms).  Then the work of each pass of a frame, "
     "the median of --repeat: shadow maps, surfaces, sky, and what it takes to "
     "read the picture back."},
    {"bench error", CMD_BENCH_ERROR, "SCENE", 1, 1,
     "measure run time against error",
     "Each method of --methods makes pictures, the path tracer's at every "
     "number of samples of --spp, and each picture is compared with a "
     "reference: of --reference, or the path engine's own with another seed "
     "and 32 times the largest number of samples.  Every picture is rendered "
     "by a facet started for it, as a user would; 'process' is the time from "
     "its start to its end, 'render' what it spent on samples or drawing.  "
     "relMSE is mean((x - ref)^2 / (ref^2 + 0.01)), 'error' its square root, "
     "'estimate' what facet said of that error without knowing the reference.  "
     "The K runs of --repeat have seeds of their own: times are medians, "
     "squared errors means.  -o draws error against time as PLOT.png or "
     "PLOT.svg.\n"
     "Methods: raster and path as they are; flat (the base colours), phong and "
     "pbr (every material by that one model) in the raster engine; naive, "
     "chapter 9's paths, mis, which look for lights with random numbers, and "
     "sobol, with even ones, all three on the binary tree, where path has the "
     "wide one; adaptive, which renders with --error down to what "
     "path estimated at each number of samples."},
    {"ibl", CMD_IBL, "ENV", 1, 1, "prepare light from an environment",
     "ENV is an equirectangular picture, R,G,B, or sky.  With -o, writes "
     "irradiance.pfm, radiance-R.pfm for each roughness R, dfg.pfm (what a "
     "rough surface reflects) and ibl.json, which says how to read them.  "
     "With --eval, answers each line 'irradiance X Y Z', 'radiance X Y Z "
     "ROUGHNESS' or 'dfg NOV ROUGHNESS' of a file by a line of numbers, as a "
     "render would see them.  What was prepared is kept; see facet cache."},
    {"bench ibl", CMD_BENCH_IBL, "ENV", 1, 1,
     "compare ways to sum the light of an environment",
     "For irradiance and for radiance at some roughness values: microseconds "
     "a value, and the largest difference to the sum over all texels in units "
     "of the largest value; then the seconds to prepare everything."},
    {"cache", CMD_CACHE, "[show|clear]", 0, 1, "show or clear what is kept",
     "Trees over meshes and sums of the light of environments are kept from "
     "run to run, under keys of all that they were made of: a picture is the "
     "same without them, later.  show lists the files, the one used last "
     "first; clear removes them.  Together they take at most 256 MiB, or "
     "FACET_CACHE_MIB MiB; what was not used for longest goes first."},
    {"help", CMD_HELP, "[COMMAND]", 0, 2, "explain facet or a command", NULL},
    {0},
};

const option option_table[OPTION_COUNT] = {
    [OPT_OUTPUT] =
        {"output", 'o', SHOWS | CMD_IBL | CMD_MERGE, OPTION_TEXT, "FILE",
         .help =
             "the picture to write, by suffix .png, .pfm, .hdr or .part; - is "
             "standard output and needs --format "
             "(default: SCENE.png in the current folder, of a shard "
             "SCENE.I-of-N.part).  Of ibl: a folder, "
             "made when it is not there.  Of bench error: the plot"},
    [OPT_FORMAT] = {"format", 0, CMD_RENDER | CMD_MERGE, OPTION_WORD,
                    "png|pfm|hdr|part",
                    .help = "file format, whatever the suffix"},
    [OPT_DEPTH] = {"depth", 0, CMD_RENDER | CMD_MERGE, OPTION_WORD, "8|16", "8",
                   .help = "bits a channel of a PNG"},
    [OPT_RESOLUTION] =
        {"resolution", 'r', SHOWS | CMD_VIEW, OPTION_SIZE, "WxH", "1280x720", 1,
         65535,
         .help = "width and height in pixels; a scene file's film line "
                 "comes before the default"},
    [OPT_RESOLUTIONS] = {"resolution", 'r', CMD_BENCH_RASTER, OPTION_SIZES,
                         "WxH,...", "480x270,960x540,1920x1080", 1, 65535,
                         .help =
                             "widths and heights in pixels, split at commas"},
    [OPT_CROP] =
        {"crop", 0, SHOWS, OPTION_BOX, "X0,Y0,X1,Y1", NULL, 0, 65535,
         .help = "render only these pixels of the full picture, half-open, "
                 "from the top left"},
    [OPT_AOV] =
        {"aov", 0, CMD_RENDER, OPTION_WORDS,
         "normal,depth,albedo,variance,samples",
         .help =
             "also write these, or some of them, as linear PFM files beside "
             "the output: NAME.normal.pfm beside NAME.png"},
    [OPT_ENGINE] = {"engine", 0, CMD_RENDER | CMD_VIEW, OPTION_WORD,
                    "raster|path|auto", "raster",
                    .help =
                        "raster: by OpenGL, in an instant, light from lamps "
                        "and sky; path: light along all ways, slowly; auto: "
                        "raster where it can, else path"},
    [OPT_GL] = {"gl", 0, DRAWS, OPTION_WORD, "auto|osmesa|egl", "auto",
                .help = "the library that the raster engine draws with; auto "
                        "tries them in this order"},
    [OPT_SHADING] = {"shading", 0, DRAWS, OPTION_WORD,
                     "auto|blinn-phong|pbr|normal|depth|albedo", "auto",
                     .help = "auto: each material by its own model"},
    [OPT_PBR_MODEL] = {"pbr-model", 0, DRAWS | CMD_IBL | CMD_BENCH_IBL,
                       OPTION_WORD, "ggx|report", "ggx",
                       .help = "formulas of metallic-roughness: those that "
                               "keep all light, or the course report's"},
    [OPT_IBL] = {"ibl", 0, DRAWS, OPTION_WORD, "lean|split", "lean",
                 .help = "where the raster engine looks up what rough metal "
                         "reflects: along the mean of its lobe (ggx), or along "
                         "the mirror direction"},
    [OPT_CAMERA] = {"camera", 0, DRAWS, OPTION_TEXT, "NAME",
                    .help =
                        "a camera of the scene file (default: the first, else "
                        "framed from the bounding box)"},
    [OPT_EYE] = {"eye", 0, DRAWS, OPTION_TRIPLE, "X,Y,Z",
                 .help = "where the camera is"},
    [OPT_TARGET] = {"target", 0, DRAWS, OPTION_TRIPLE, "X,Y,Z",
                    .help = "the point in the middle of the picture"},
    [OPT_UP] = {"up", 0, DRAWS, OPTION_TRIPLE, "X,Y,Z",
                .help = "the direction that is up in the picture"},
    [OPT_FOV] = {"fov", 0, DRAWS, OPTION_NUMBER, "DEG", NULL, 0, 180, true,
                 "vertical field of view"},
    [OPT_UP_AXIS] = {"up-axis", 0, DRAWS | CMD_INFO, OPTION_WORD, "Y|Z", "Y",
                     .help = "the axis that is up in the OBJ"},
    [OPT_ENV] =
        {"env", 0, DRAWS, OPTION_TEXT, "FILE|R,G,B|none",
         .help = "the light from everywhere: an equirectangular picture, a "
                 "constant radiance, or darkness (default: the scene file's, "
                 "else a built-in sky)"},
    [OPT_ENV_ROTATE] = {"env-rotate", 0, DRAWS, OPTION_NUMBER, "DEG", NULL,
                        -1e6, 1e6, .help = "turn it about the vertical"},
    [OPT_ENV_SCALE] = {"env-scale", 0, DRAWS, OPTION_NUMBER, "S", NULL, 0, 1e9,
                       .help = "multiply it"},
    [OPT_LIGHTS] = {"lights", 0, DRAWS, OPTION_WORD, "on|off", "on",
                    .help = "point and directional lights of the scene"},
    [OPT_SHADOWS] = {"shadows", 0, DRAWS, OPTION_WORD, "on|off", "on",
                     .help = "of these lights, in the raster engine"},
    [OPT_MSAA] = {"msaa", 0, DRAWS, OPTION_WHOLE, "N", "4", 1, 64,
                  .help = "samples a pixel of the raster engine, as many as "
                          "the driver can"},
    [OPT_SHADE] = {"shade", 0, DRAWS, OPTION_WORD, "pixels|triangles", "pixels",
                   .help = "pixels: once each, where nothing has textures; "
                           "triangles: each where it is drawn"},
    [OPT_NORMALS] =
        {"normals", 0, DRAWS | CMD_BENCH_LOAD, OPTION_WORD,
         "auto|file|smooth|flat", "auto",
         .help = "auto: the file's, else by smoothing groups, else flat"},
    [OPT_CREASE] =
        {"crease", 0, DRAWS | CMD_BENCH_LOAD, OPTION_NUMBER, "DEG", "180", 0,
         180, .help = "faces that differ by more are not smoothed together"},
    [OPT_NO_NAME_RULES] = {"no-name-rules", 0, DRAWS | CMD_INFO, OPTION_SWITCH,
                           .help =
                               "names such as glass or mirror decide nothing"},
    [OPT_ALLOW_OUTSIDE] =
        {"allow-outside", 0, DRAWS | CMD_INFO, OPTION_SWITCH,
         .help = "files of the scene may name others outside of the folder of "
                 "SCENE: ../x.png, /x.png, links that lead there"},
    [OPT_SPP] = {"spp", 0, CMD_RENDER, OPTION_WHOLE, "N", "64", 1, 1 << 24,
                 .help = "samples a pixel; not limited where --time or --error "
                         "is given without it"},
    [OPT_SPPS] = {"spp", 0, CMD_BENCH_ERROR, OPTION_WHOLES, "N,...",
                  "1,4,16,64", 1, 1 << 19, .help = "samples a pixel, in turn"},
    [OPT_TIME] =
        {"time", 0, CMD_RENDER, OPTION_NUMBER, "SECONDS", NULL, 0, 1e9, true,
         "stop in time to be done this long after the start; samples go "
         "where they help"},
    [OPT_ERROR] = {"error", 0, CMD_RENDER, OPTION_NUMBER, "REL", NULL, 0, 1e9,
                   true,
                   "stop when the estimated relative error of the "
                   "picture is below this; samples go where they help, and "
                   "the estimate is within 10 % of the error"},
    [OPT_SHARD] = {"shard", 0, CMD_RENDER, OPTION_TEXT, "I/N",
                   .help = "render the tiles of hand I of N, into a .part; I "
                           "from 1, or from 0, where 0 is N"},
    [OPT_CHECKPOINT] = {"checkpoint", 0, CMD_RENDER, OPTION_TEXT, "FILE",
                        .help =
                            "save what there is of the picture, at the end, "
                            "at a signal and from time to time"},
    [OPT_EVERY] = {"every", 0, CMD_RENDER, OPTION_NUMBER, "SECONDS", "60", 0,
                   1e9,
                   .help = "how often: at the first end of a pass after that"},
    [OPT_RESUME] = {"resume", 0, CMD_RENDER, OPTION_SWITCH,
                    .help = "go on from the checkpoint, if it is there"},
    [OPT_MAX_DEPTH] = {"max-depth", 0, SHOWS | CMD_VIEW, OPTION_WHOLE, "N", "0",
                       0, 1000000,
                       .help =
                           "segments of a path: 1 sees lights, 2 adds direct "
                           "light; 0: no limit, paths end by chance"},
    [OPT_SEED] = {"seed", 0, SHOWS | CMD_VIEW | CMD_BENCH_RAYS, OPTION_WHOLE,
                  "N", "0", 0, 9007199254740992.0,
                  .help = "another seed, other noise"},
    [OPT_INTEGRATOR] = {"integrator", 0, SHOWS, OPTION_WORD, "auto|naive|mis",
                        "auto",
                        .help = "how paths look for light; auto also learns"},
    [OPT_SAMPLER] = {"sampler", 0, SHOWS, OPTION_WORD, "sobol|random", "sobol",
                     .help =
                         "where random numbers come from; naive has its own"},
    [OPT_BVH] = {"bvh", 0, SHOWS | CMD_BENCH_RAYS, OPTION_WORD,
                 "auto|binary|wide|brute|fast|high", "auto",
                 .help = "how triangles are found; brute tests every one, high "
                         "cuts large ones, auto when it pays"},
    [OPT_EXPOSURE] = {"exposure", 0, CMD_RENDER | CMD_VIEW | CMD_MERGE,
                      OPTION_NUMBER, "STOPS", NULL, -64, 64,
                      .help =
                          "brightness of a PNG, one stop doubles (default: the "
                          "scene file's, else 0)"},
    [OPT_TONEMAP] = {"tonemap", 0, CMD_RENDER | CMD_VIEW | CMD_MERGE,
                     OPTION_WORD, "none|reinhard|aces", "none",
                     .help =
                         "curve that brings a PNG's highlights below white"},
    [OPT_POST] = {"post", 0, CMD_RENDER | CMD_VIEW | CMD_MERGE, OPTION_TEXT,
                  "frosted[=RADIUS]",
                  .help = "the picture behind a pane of frosted glass, whose "
                          "grains look up to RADIUS pixels away; frosted "
                          "alone is frosted=8"},
    [OPT_SCRIPT] = {"script", 0, CMD_VIEW, OPTION_TEXT, "FILE",
                    .help = "no window: do what FILE says, one statement a "
                            "line: key NAME [down|up], mouse DX DY, wait "
                            "SECONDS, spp N, frame OUT"},
    [OPT_SCENE] = {"scene", 0, CMD_INFO, OPTION_SWITCH,
                   .help = "print a complete scene file for what is in force"},
    [OPT_METRIC] = {"metric", 0, CMD_COMPARE, OPTION_WORD,
                    "rmse|mae|psnr|relmse|max|p99.9", "rmse",
                    .help = "the one that decides"},
    [OPT_FAIL] = {"fail", 0, CMD_COMPARE, OPTION_NUMBER, "T", NULL, 0, 1e30,
                  .help =
                      "the largest difference that is still equal; for psnr "
                      "the smallest number of dB (default: none at all)"},
    [OPT_DIFF] = {"diff", 0, CMD_COMPARE, OPTION_TEXT, "OUT.png",
                  .help = "write |A - B|, amplified by a printed power of two"},
    [OPT_Z_TEST] = {"z-test", 0, CMD_COMPARE, OPTION_TEXT, "REF-VARIANCE.pfm",
                    .help = "decide by a z-test of every pixel instead, given "
                            "the variance of B's pixels"},
    [OPT_KIND] =
        {"kind", 0, CMD_BENCH_RAYS, OPTION_WORD, "primary|ao|aod|bounce|random",
         "primary",
         .help = "the rays to make: from a camera, to the sky, the same cut "
                 "short, after a bounce, between random points"},
    [OPT_RAYS] = {"rays", 0, CMD_BENCH_RAYS, OPTION_TEXT, "FILE",
                  .help = "trace the rays of a file instead"},
    [OPT_HITS] = {"hits", 0, CMD_BENCH_RAYS, OPTION_TEXT, "FILE",
                  .help = "write what they hit"},
    [OPT_EVAL] = {"eval", 0, CMD_IBL, OPTION_TEXT, "FILE",
                  .help = "answer the lines of this file, - is standard input"},
    [OPT_REPEAT] = {"repeat", 0,
                    CMD_BENCH_LOAD | CMD_BENCH_RAYS | CMD_BENCH_RASTER |
                        CMD_BENCH_IBL,
                    OPTION_WHOLE, "K", "5", 1, 1000,
                    .help = "runs; the median counts"},
    [OPT_RUNS] = {"repeat", 0, CMD_BENCH_ERROR, OPTION_WHOLE, "K", "1", 1, 1000,
                  .help = "pictures a point, each with a seed of its own"},
    [OPT_METHODS] = {"methods", 0, CMD_BENCH_ERROR, OPTION_WORDS,
                     "raster,path,flat,phong,pbr,naive,mis,sobol,adaptive",
                     "raster,path", .help = "what to compare"},
    [OPT_REFERENCE] = {"reference", 0, CMD_BENCH_ERROR, OPTION_TEXT, "REF.pfm",
                       .help = "the truth (default: rendered)"},
    [OPT_FRAMES] = {"frames", 0, CMD_BENCH_RASTER, OPTION_WHOLE, "N", "1000", 1,
                    1000000, .help = "frames to draw at each size"},
    [OPT_CSV] = {"csv", 0, CMD_BENCH_RASTER | CMD_BENCH_ERROR, OPTION_SWITCH,
                 .help = "print lines of comma-separated values"},
    [OPT_MAN] = {"man", 0, CMD_HELP, OPTION_SWITCH,
                 .help = "print the manual page of facet, or of the command, "
                         "for man -l -"},
    [OPT_COMPLETION] = {"completion", 0, CMD_HELP, OPTION_WORD, "bash|zsh|fish",
                        .help = "print what lets this shell complete the "
                                "command line"},
    [OPT_NO_CACHE] =
        {"no-cache", 0, CMD_RENDER | CMD_VIEW | CMD_IBL, OPTION_SWITCH,
         .help = "neither read nor write the cache; the picture is the same"},
    [OPT_THREADS] =
        {"threads", 'j',
         CMD_ALL & ~(CMD_COMPARE | CMD_HELP | CMD_MERGE | CMD_CACHE),
         OPTION_WHOLE, "N", NULL, 1, 1024,
         .help = "worker threads (default: what CPU affinity, the cgroup's "
                 "quota and SLURM_CPUS_PER_TASK allow)"},
    [OPT_EXPLAIN] =
        {"explain", 0, CMD_RENDER, OPTION_SWITCH,
         .help = "print the plan on standard error: of each stage how much was "
                 "needed, why, and its seconds and bytes"},
    [OPT_NO_SKIP] =
        {"no-skip", 0, CMD_RENDER, OPTION_SWITCH,
         .help = "do what the picture does not need as well: the same picture, "
                 "later; for measuring what --explain says is saved"},
    [OPT_STRICT] =
        {"strict", 0, CMD_RENDER | CMD_VIEW, OPTION_SWITCH,
         .help = "a warning is an error: exit status 1, nothing written"},
    [OPT_JSON] = {"json", 0, CMD_ALL & ~(CMD_HELP | CMD_VIEW | CMD_IBL),
                  OPTION_SWITCH,
                  .help = "print one JSON object on standard output"},
    [OPT_QUIET] = {"quiet", 'q', CMD_IBL | DRAWS | CMD_COMPARE | CMD_MERGE,
                   OPTION_SWITCH, .help = "print errors only"},
    [OPT_VERBOSE] = {"verbose", 'v', DRAWS | CMD_INFO, OPTION_SWITCH,
                     .help = "print notes, too"},
    [OPT_NO_COLOR] = {"no-color", 0, CMD_ALL, OPTION_SWITCH,
                      .help = "no colours on a terminal, as with NO_COLOR set"},
    [OPT_HELP] = {"help", 'h', CMD_ALL, OPTION_SWITCH,
                  .help = "explain the command"},
};

const char *const later_words[] = {
    "wide",
    ".exr",
    "exr",
    NULL,
};
