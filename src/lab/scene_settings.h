#ifndef ETALON_LAB_SCENE_SETTINGS_H
#define ETALON_LAB_SCENE_SETTINGS_H

/* Between a scene file and the settings of a run. */

#include "settings/settings.h"

/* Applies the settings that the scene file gives. */
bool scene_settings_apply(const struct scene_desc *desc, struct settings *settings,
                          struct err *err);

/* How the scene is built under these settings. */
struct scene_options scene_settings_options(const struct settings *settings);

#endif
