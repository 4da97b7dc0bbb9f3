#include "import/import.h"

#include "base/text.h"

struct scene_desc *import_scene(const char *path, const struct import_options *options,
                                struct err *err)
{
    static const struct {
        const char *ending;
        struct scene_desc *(*read)(const char *path, const struct import_options *options,
                                   struct err *err);
    } rows[] = {{".yaml", import_yaml},
                {".yml", import_yaml},
                {".pbrt", import_pbrt},
                {".lxs", import_pbrt},
                {".xml", import_mitsuba}};
    struct place at = {path, 0, 0};
    if (options && options->definition_count > 0 && !text_ends_with(path, ".xml")) {
        err_set(err, ERR_USAGE, &at,
                "'%s' defines nothing here: only Mitsuba's files (.xml) have parameters",
                options->definitions[0]);
        return NULL;
    }
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (text_ends_with(path, rows[i].ending))
            return rows[i].read(path, options, err);
    err_set(err, ERR_UNSUPPORTED, &at,
            "the ending names no kind of scene that is read: .yaml (or .yml), .pbrt, "
            ".lxs, .xml");
    return NULL;
}
