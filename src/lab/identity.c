#include "lab/identity.h"

#include "base/mem.h"
#include "build_info.h"
#include "lab/fingerprint.h"
#include "scene/accel.h"
#include "settings/setting.h"

static void add_program(struct identity *identity, const struct scene *scene)
{
    identity_add(identity, "commit", "%s", BUILD_COMMIT);
    identity_add(identity, "compiler", "%s", BUILD_COMPILER);
    identity_add(identity, "flags", "%s", BUILD_FLAGS);
    identity_add(identity, "rays", "%s", accel_description(scene->accel));
}

static void add_settings(struct identity *identity, const struct settings *settings,
                         const struct scene *scene)
{
    struct settings resolved = settings_resolve(settings, scene);
    for (int i = 0; settings_row(i); i++) {
        const struct setting *setting = settings_row(i);
        struct text text = {0};
        if (setting->resume != RESUME_SAME)
            continue;
        setting_print(setting, &resolved, &text);
        identity_add(identity, setting->name, "%s", text.data ? text.data : "");
        mem_free(text.data);
    }
}

static void add_hash(struct identity *identity, const char *name, const struct hash *hash)
{
    char digits[HASH_DIGITS + 1];
    hash_digits(hash, digits);
    identity_add(identity, name, "%s", digits);
}

bool identity_init(struct identity *identity, const char *scene_path,
                   const struct scene *scene, const struct settings *settings,
                   const char *reference, struct err *err)
{
    struct hash hash;
    *identity = (struct identity){0};
    add_program(identity, scene);
    if (!fingerprint_scene(scene_path, NULL, &hash, err))
        return false;
    add_hash(identity, "content of the scene", &hash);
    identity_add(identity, IDENTITY_DEFINITIONS, "%s",
                 scene->desc && scene->desc->definitions ? scene->desc->definitions
                                                         : "none");
    add_settings(identity, settings, scene);
    if (reference == NULL) {
        identity_add(identity, "reference of the error log", "none");
        return true;
    }
    hash_init(&hash);
    if (!fingerprint_file(reference, NULL, &hash, err))
        return false;
    add_hash(identity, "reference of the error log", &hash);
    return true;
}
