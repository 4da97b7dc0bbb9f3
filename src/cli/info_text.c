#include "base/mem.h"
#include "cli/info.h"
#include "run/blind_spots.h"

#define LABEL "%-11s "

static double megabytes(double bytes)
{
    return bytes / 0x1p20;
}

static void print_film(const struct session *session, FILE *out)
{
    const struct scene *scene = session->scene;
    const struct camera *camera = &scene->camera;
    const char *whose = session->settings.max_depth > 0 ? "as set"
                        : scene->max_depth > 0          ? "the file's own"
                                                        : "the default";
    fprintf(out, LABEL "%dx%d pixels\n", "film", camera->width, camera->height);
    fprintf(out, LABEL "%d edges (%s)\n", "max depth",
            settings_depth(&session->settings, scene), whose);
    if (scene->hide_emitters)
        fprintf(out, LABEL "emitters that the camera sees directly; channel A is alpha\n",
                "hidden");
    fprintf(out, LABEL "at (%g, %g, %g) towards (%g, %g, %g), ", "camera",
            (double)camera->origin.x, (double)camera->origin.y, (double)camera->origin.z,
            (double)camera->axes.n.x, (double)camera->axes.n.y, (double)camera->axes.n.z);
    if (camera->orthographic)
        fprintf(out, "orthographic, %g x %g, ", camera->dx, -camera->dy);
    if (camera->lens_radius > 0.0)
        fprintf(out, "thin lens of radius %g focused at %g\n", camera->lens_radius,
                camera->focus_distance);
    else
        fprintf(out, "pinhole\n");
}

static void print_counts(const char *label, const struct info_counts *counts, FILE *out)
{
    fprintf(out, LABEL "%ld", label, counts->total);
    for (int i = 0; i < counts->kinds; i++)
        fprintf(out, ", %s %ld", counts->rows[i].name, counts->rows[i].count);
}

static void print_contents(const struct info *info, FILE *out)
{
    const struct scene *scene = info->session->scene;
    const struct texture_set *set = &scene->desc->textures;
    print_counts("shapes", &info->shapes, out);
    fprintf(out, "; %zu triangles", info->triangles);
    if (scene->desc->instances.count > 0)
        fprintf(out, "; %zu instances (%zu share the triangles of their object)",
                scene->desc->instances.count, scene->instance_count);
    fputc('\n', out);
    print_counts("materials", &info->materials, out);
    fputc('\n', out);
    if (set->count + set->image_count > 0)
        fprintf(out, LABEL "%zu, of %zu pictures\n", "textures", set->count,
                set->image_count);
    print_counts("lights", &info->lights, out);
    fprintf(out, "; emission is scaled by 1/%g\n", scene->emission_scale);
}

static void print_cost(const struct info *info, FILE *out)
{
    const struct session *session = info->session;
    const struct scene *scene = session->scene;
    const struct memory *memory = &info->memory;
    fprintf(out, LABEL "(%g, %g, %g) to (%g, %g, %g)\n", "bounds",
            (double)scene->bounds_min.x, (double)scene->bounds_min.y,
            (double)scene->bounds_min.z, (double)scene->bounds_max.x,
            (double)scene->bounds_max.y, (double)scene->bounds_max.z);
    fprintf(out, LABEL "%s; BVH %s: %s\n", "rays", accel_description(scene->accel),
            accel_is_compact(scene->accel) ? "compact" : "in full",
            accel_reason(scene->accel));
    fprintf(out,
            LABEL
            "geometry %.1f MB, BVH %.1f MB (asked for %.1f), textures %.1f MB, lights "
            "%.1f MB\n",
            "memory", megabytes((double)memory->geometry), megabytes(memory->resident),
            megabytes((double)memory->bvh), megabytes((double)memory->textures),
            megabytes((double)memory->lights));
    fprintf(out,
            LABEL "%s: at most films %.1f MB (of which %.1f MB only where splats are "
                  "very small or large), states %.1f MB, pictures %.1f MB\n",
            "", session->settings.integrator, megabytes(info->run.films),
            megabytes(info->run.rare), megabytes(info->run.states),
            megabytes(info->run.pictures));
    fprintf(out, LABEL "a render at most %.1f MB; %.1f MB are available%s\n", "",
            megabytes(info_render_peak(info)), megabytes(info->available_bytes),
            run_memory_sum(&info->run) > info->available_bytes ? ": it would be refused"
                                                               : "");
    fprintf(out,
            LABEL "%.2f s, of which %.2f s reading; %.1f MB at most, %.1f MB before the "
                  "BVH\n",
            "loading", session->load_seconds, session->load_seconds - scene->load_seconds,
            megabytes(info->peak_bytes), megabytes(scene->load_peak));
}

static void print_needs(const struct needs *needs, FILE *out)
{
    int count = 0;
    fprintf(out, "needs\n");
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (needs_get(needs, row))
            fprintf(out, "  %s\n", row->name);
    fprintf(out, "left out\n");
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (!needs_get(needs, row)) {
            fprintf(out, "  %-26s %s\n", row->name, row->reason);
            count++;
        }
    if (count == 0)
        fprintf(out, "  nothing%s\n", needs->keep_all ? ": keep_all is set" : "");
}

static void print_blind_spots(const struct session *session, FILE *out)
{
    struct text text = {0};
    if (blind_spots_tell(session->scene->desc, &session->settings,
                         settings_depth(&session->settings, session->scene), &text))
        fprintf(out, "blind spots\n  %s\n", text.data);
    mem_free(text.data);
}

static void print_file_settings(const struct scene_desc *desc, FILE *out)
{
    if (desc->setting_count > 0)
        fprintf(out, "settings of the file\n");
    for (size_t i = 0; i < desc->setting_count; i++) {
        const struct setting_desc *s = &desc->settings[i];
        fprintf(out, "  %s = %s (%s:%d:%d)\n", s->key, s->value,
                s->place.file ? s->place.file : desc->path, s->place.line, s->place.col);
    }
}

bool info_is_complete(const struct info *info)
{
    const struct session *session = info->session;
    return log_losses(&session->scene->desc->log, session->note_count) == 0;
}

void info_check(const struct info *info, FILE *out)
{
    const struct session *session = info->session;
    if (info_is_complete(info))
        fprintf(out, "nothing is left out\n");
    log_print_losses(&session->scene->desc->log, session->note_count, out);
}

void info_text(const struct info *info, FILE *out)
{
    const struct scene *scene = info->session->scene;
    fprintf(out, LABEL "%s\n", "scene", scene->desc->path);
    print_film(info->session, out);
    print_contents(info, out);
    print_cost(info, out);
    print_needs(&scene->needs, out);
    print_blind_spots(info->session, out);
    print_file_settings(scene->desc, out);
    if (scene->desc->log.count > 0)
        fprintf(out, "notes of loading\n");
    log_print(&scene->desc->log, out);
}
