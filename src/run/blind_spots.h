#ifndef ETALON_RUN_BLIND_SPOTS_H
#define ETALON_RUN_BLIND_SPOTS_H

/* Light that the chosen integrator cannot sample in a scene, see path/blind.h. */

#include "base/text.h"
#include "path/blind.h"
#include "settings/settings.h"

/* Path families, comma-separated; "" if there are none. max_depth: edges, as resolved. */
void blind_spots(const struct scene_desc *desc, const struct settings *settings,
                 int max_depth, char text[BLIND_TEXT]);
/* The same as a sentence with their names in words; false if there are none. */
bool blind_spots_tell(const struct scene_desc *desc, const struct settings *settings,
                      int max_depth, struct text *text);

#endif
