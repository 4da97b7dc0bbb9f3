#include "lab/scene_settings.h"

bool scene_settings_apply(const struct scene_desc *desc, struct settings *settings,
                          struct err *err)
{
    for (size_t i = 0; i < desc->setting_count; i++) {
        const struct setting_desc *s = &desc->settings[i];
        if (!settings_set(settings, s->key, s->value, &s->place, err))
            return false;
    }
    return true;
}

struct scene_options scene_settings_options(const struct settings *settings)
{
    return (struct scene_options){.width = (int)settings->width,
                                  .height = (int)settings->height,
                                  .keep_all = settings->keep_all,
                                  .threads = (int)settings->threads,
                                  .compact = settings->compact};
}
