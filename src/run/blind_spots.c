#include "run/blind_spots.h"

#include "integrator/registry.h"

static unsigned techniques_of(const struct settings *settings)
{
    return integrator_find(settings->integrator)->techniques(settings);
}

void blind_spots(const struct scene_desc *desc, const struct settings *settings,
                 int max_depth, char text[BLIND_TEXT])
{
    struct needs needs = needs_of_desc(desc);
    blind_text(&needs, techniques_of(settings), max_depth, text);
}

bool blind_spots_tell(const struct scene_desc *desc, const struct settings *settings,
                      int max_depth, struct text *text)
{
    const struct blind_family *found[BLIND_FAMILIES];
    struct needs needs = needs_of_desc(desc);
    int count = blind_find(&needs, techniques_of(settings), max_depth, found);
    if (count == 0)
        return false;
    bool over_pt = settings_uses(settings, "builder") &&
                   text_equal(settings->builder, "pt");
    text_append(text, "%s%s cannot sample all light of %s: ", settings->integrator,
                over_pt ? " over pt" : "",
                !needs.distant_lights ? "point and spot lights"
                : needs.point_lights  ? "point, spot and distant lights"
                                      : "distant lights");
    for (int i = 0; i < count; i++)
        text_append(text, "%s%s (%s)", i ? ", " : "", found[i]->paths, found[i]->words);
    text_append(text, "; what the scene has of these is missing from the picture");
    return true;
}
