#include "cli/options.h"

#include <stddef.h>

const struct arg_option options_scene[] = {
    {"size", 0, "WxH", "size", "pixels, as if the film's resolution were edited"},
    {"max-depth", 0, "N", "max_depth",
     "longest path in edges, camera to light: 1 sees emitters, 2 direct light; -1 is 64"},
    {"threads", 0, "N", "threads", "0 = all"},
    {"set", 0, "KEY=VALUE", NULL, "any setting; may be repeated, the last one counts"},
    {"define", 'D', "NAME=VALUE", NULL,
     "a $parameter of a Mitsuba scene, as Mitsuba's -D; may be repeated"},
    {0},
};

const struct arg_option options_run[] = {
    {"integrator", 'i', "NAME", "integrator", "see below"},
    {"large-step", 0, "auto|P", "large_step_probability",
     "large-step probability p_l: measured, or a number in (0,1]"},
    {"seconds", 0, "S", "seconds", "budget of wall time"},
    {"mpp", 0, "N", "mutations_per_pixel", "budget in mutations per pixel"},
    {"spp", 0, "N", "mutations_per_pixel", "the same for samples of pt and bdpt"},
    {"seed", 0, "N", "seed", "random numbers: the same seed gives the same picture"},
    {0},
};
