#include "import/spectrum_named.h"

#include "base/text.h"
#include "import/spectrum.h"

/* Metals: the measured optical constants that pbrt and Mitsuba ship (Palik's handbook and
 * the SOPRA database), at every second or third of their wavelengths; brass, 70 % copper,
 * [Querry 1985]. Glasses: Schott's catalogue. Both as in refractiveindex.info. */
static const double ag_eta[] = {
    393.6,  0.182,   413.28, 0.173,   435.03, 0.1585,  459.2,  0.144,   486.21, 0.13025,
    506.06, 0.12994, 527.59, 0.13006, 551.04, 0.12438, 563.56, 0.12,    576.67, 0.11931,
    590.4,  0.121,   604.8,  0.1255,  635.82, 0.13613, 670.18, 0.14006, 708.48, 0.14431};
static const double ag_k[] = {
    393.6,  1.87875, 413.28, 2.11,    435.03, 2.32938, 459.2,  2.56,    486.21, 2.79813,
    506.06, 2.97375, 527.59, 3.15938, 551.04, 3.34813, 563.56, 3.45,    576.67, 3.55375,
    590.4,  3.66,    604.8,  3.76625, 635.82, 4.01063, 670.18, 4.29313, 708.48, 4.58625};
static const double al_eta[] = {
    393.6,  0.47469, 413.28, 0.523, 435.03, 0.57731, 459.2,  0.644, 486.21, 0.72375,
    506.06, 0.789,   527.59, 0.867, 551.04, 0.963,   563.56, 1.02,  576.67, 1.08,
    590.4,  1.15,    604.8,  1.22,  635.82, 1.39,    670.18, 1.6,   708.48, 1.91};
static const double al_k[] = {393.6,  4.78438, 413.28, 5.02, 435.03, 5.29, 459.2,  5.58,
                              486.21, 5.915,   506.06, 6.15, 527.59, 6.42, 551.04, 6.7,
                              563.56, 6.85,    576.67, 7,    590.4,  7.15, 604.8,  7.31,
                              635.82, 7.65,    670.18, 8.01, 708.48, 8.39};
static const double au_eta[] = {
    393.6,  1.666,  413.28, 1.636,   435.03, 1.59625, 459.2,  1.426, 486.21, 1.08675,
    506.06, 0.7545, 527.59, 0.49175, 551.04, 0.3455,  563.56, 0.306, 576.67, 0.26763,
    590.4,  0.236,  604.8,  0.21238, 635.82, 0.17775, 670.18, 0.161, 708.48, 0.16088};
static const double au_k[] = {
    393.6,  1.94775, 413.28, 1.958,   435.03, 1.9245,  459.2,  1.846,   486.21, 1.79738,
    506.06, 1.9565,  527.59, 2.32625, 551.04, 2.73063, 563.56, 2.88,    576.67, 2.94063,
    590.4,  2.97,    604.8,  3.015,   635.82, 3.07,    670.18, 3.44581, 708.48, 4.08769};
static const double cu_eta[] = {
    393.6,  1.17438, 413.28, 1.18,    435.03, 1.17281, 459.2,  1.16,    486.21, 1.14281,
    506.06, 1.13156, 527.59, 1.09244, 551.04, 0.95038, 563.56, 0.826,   576.67, 0.64588,
    590.4,  0.468,   604.8,  0.35125, 635.82, 0.23081, 670.18, 0.20925, 708.48, 0.21625};
static const double cu_k[] = {
    393.6,  2.17719, 413.28, 2.21,    435.03, 2.326,   459.2,  2.433,   486.21, 2.53588,
    506.06, 2.58963, 527.59, 2.59556, 551.04, 2.5765,  563.56, 2.599,   576.67, 2.67806,
    590.4,  2.809,   604.8,  3.01075, 635.82, 3.45819, 670.18, 3.86313, 708.48, 4.23956};
static const double cuzn_eta[] = {450, 1.094, 550, 0.527, 650, 0.444};
static const double cuzn_k[] = {450, 1.829, 550, 2.765, 650, 3.695};
static const double mgo_eta[] = {404.63,  1.76104, 435.78,  1.75471, 486,
                                 1.74711, 546.17,  1.74077, 589.26,  1.73737,
                                 656.33,  1.73335, 706.44,  1.73101};
static const double tio2_eta[] = {399.94, 3.4,  439.96, 3.2, 479.99, 3.08, 520.05, 3,
                                  559.98, 2.94, 600.1,  2.9, 640.06, 2.87, 700.06, 2.83};
static const double clear_k[] = {550, 0};
static const double bk7[] = {410, 1.52957, 454, 1.52496, 498, 1.52155, 542, 1.51893,
                             586, 1.51687, 630, 1.51519, 674, 1.51379};
static const double baf10[] = {414, 1.69246, 457, 1.68418, 500, 1.67819, 543, 1.67365,
                               586, 1.67011, 629, 1.66727, 672, 1.66495};
static const double fk51a[] = {400, 1.49657, 444, 1.49302, 488, 1.49042, 533, 1.48843,
                               577, 1.48688, 621, 1.48562, 665, 1.48459};
static const double lasf9[] = {412, 1.89454, 455, 1.87786, 497, 1.86614, 540, 1.85748,
                               583, 1.85087, 625, 1.84566, 668, 1.84146};
static const double sf5[] = {412, 1.7079,  455, 1.69455, 497, 1.68524, 540, 1.67841,
                             583, 1.67319, 625, 1.66909, 668, 1.66578};
static const double sf10[] = {401, 1.77761, 443, 1.75906, 486, 1.74646, 528, 1.73737,
                              570, 1.73053, 613, 1.72521, 655, 1.72097, 698, 1.7175};
static const double sf11[] = {412, 1.83747, 455, 1.81709, 497, 1.80316, 540, 1.79305,
                              583, 1.78543, 625, 1.77948, 668, 1.77472};

#define PAIRS(array) (array), sizeof(array) / sizeof(array)[0] / 2

static const struct {
    const char *name;
    const double *pairs;
    size_t count;
} rows[] = {
    {"metal-Ag-eta", PAIRS(ag_eta)},
    {"metal-Ag-k", PAIRS(ag_k)},
    {"metal-Al-eta", PAIRS(al_eta)},
    {"metal-Al-k", PAIRS(al_k)},
    {"metal-Au-eta", PAIRS(au_eta)},
    {"metal-Au-k", PAIRS(au_k)},
    {"metal-Cu-eta", PAIRS(cu_eta)},
    {"metal-Cu-k", PAIRS(cu_k)},
    {"metal-CuZn-eta", PAIRS(cuzn_eta)},
    {"metal-CuZn-k", PAIRS(cuzn_k)},
    {"metal-MgO-eta", PAIRS(mgo_eta)},
    {"metal-MgO-k", PAIRS(clear_k)},
    {"metal-TiO2-eta", PAIRS(tio2_eta)},
    {"metal-TiO2-k", PAIRS(clear_k)},
    {"glass-BK7", PAIRS(bk7)},
    {"glass-BAF10", PAIRS(baf10)},
    {"glass-FK51A", PAIRS(fk51a)},
    {"glass-LASF9", PAIRS(lasf9)},
    {"glass-F5", PAIRS(sf5)},
    {"glass-F10", PAIRS(sf10)},
    {"glass-F11", PAIRS(sf11)},
};

/* Chromaticities [CIE 15:2004], ACES's white [SMPTE ST 2065-1]. */
static const struct {
    const char *name;
    double x, y;
} illuminants[] = {
    {"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35850},
    {"stdillum-D65", 0.31271, 0.32902}, {"stdillum-ACES-D60", 0.32168, 0.33767},
    {"stdillum-F1", 0.31310, 0.33727},  {"stdillum-F2", 0.37208, 0.37529},
    {"stdillum-F3", 0.40910, 0.39430},  {"stdillum-F4", 0.44018, 0.40329},
    {"stdillum-F5", 0.31379, 0.34531},  {"stdillum-F6", 0.37790, 0.38835},
    {"stdillum-F7", 0.31292, 0.32933},  {"stdillum-F8", 0.34588, 0.35875},
    {"stdillum-F9", 0.37417, 0.37281},  {"stdillum-F10", 0.34609, 0.35986},
    {"stdillum-F11", 0.38052, 0.37713}, {"stdillum-F12", 0.43695, 0.40441},
};

bool spectrum_named(const char *name, const double **pairs, size_t *count)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (text_equal(name, rows[i].name)) {
            *pairs = rows[i].pairs;
            *count = rows[i].count;
            return true;
        }
    return false;
}

bool spectrum_named_illuminant(const char *name, struct rgb *value)
{
    for (size_t i = 0; i < sizeof illuminants / sizeof illuminants[0]; i++)
        if (text_equal(name, illuminants[i].name)) {
            *value = spectrum_from_chromaticity(illuminants[i].x, illuminants[i].y);
            return true;
        }
    return false;
}
