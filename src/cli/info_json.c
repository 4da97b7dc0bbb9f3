#include "base/json.h"
#include "cli/info.h"
#include "run/blind_spots.h"

static void write_vector(struct json *json, const char *key, struct vec3 v)
{
    json_open(json, key, '[');
    json_number(json, NULL, (double)v.x);
    json_number(json, NULL, (double)v.y);
    json_number(json, NULL, (double)v.z);
    json_close(json, '[');
}

static void write_film(struct json *json, const struct session *session)
{
    const struct camera *camera = &session->scene->camera;
    json_open(json, "film", '{');
    json_count(json, "width", camera->width);
    json_count(json, "height", camera->height);
    json_close(json, '{');
    json_count(json, "max_depth", settings_depth(&session->settings, session->scene));
    json_flag(json, "hide_emitters", session->scene->hide_emitters);
    json_open(json, "camera", '{');
    write_vector(json, "origin", camera->origin);
    write_vector(json, "towards", camera->axes.n);
    json_flag(json, "orthographic", camera->orthographic);
    json_number(json, "lens_radius", camera->lens_radius);
    json_number(json, "focus_distance", camera->focus_distance);
    json_close(json, '{');
}

static void write_counts(struct json *json, const char *key,
                         const struct info_counts *counts)
{
    json_open(json, key, '{');
    json_count(json, "total", counts->total);
    for (int i = 0; i < counts->kinds; i++)
        json_count(json, counts->rows[i].name, counts->rows[i].count);
    json_close(json, '{');
}

static void write_contents(struct json *json, const struct info *info)
{
    const struct scene *scene = info->session->scene;
    write_counts(json, "shapes", &info->shapes);
    json_count(json, "triangles", (long)info->triangles);
    json_count(json, "instances", (long)scene->desc->instances.count);
    json_count(json, "instances_shared", (long)scene->instance_count);
    write_counts(json, "materials", &info->materials);
    json_count(json, "textures", (long)scene->desc->textures.count);
    json_count(json, "pictures", (long)scene->desc->textures.image_count);
    write_counts(json, "lights", &info->lights);
    json_number(json, "emission_scale", scene->emission_scale);
    json_open(json, "bounds", '[');
    write_vector(json, NULL, scene->bounds_min);
    write_vector(json, NULL, scene->bounds_max);
    json_close(json, '[');
}

static void write_cost(struct json *json, const struct info *info)
{
    const struct session *session = info->session;
    json_text(json, "rays", accel_description(session->scene->accel));
    json_flag(json, "bvh_compact", accel_is_compact(session->scene->accel));
    json_text(json, "bvh_reason", accel_reason(session->scene->accel));
    json_open(json, "memory_bytes", '{');
    json_count(json, "geometry", (long)info->memory.geometry);
    json_count(json, "bvh", (long)info->memory.bvh);
    json_count(json, "bvh_resident", (long)info->memory.resident);
    json_count(json, "textures", (long)info->memory.textures);
    json_count(json, "lights", (long)info->memory.lights);
    json_count(json, "films_at_most", (long)info->run.films);
    json_count(json, "films_rare", (long)info->run.rare);
    json_count(json, "states_at_most", (long)info->run.states);
    json_count(json, "pictures_at_most", (long)info->run.pictures);
    json_count(json, "process_peak", (long)info->peak_bytes);
    json_count(json, "render_peak_at_most", (long)info_render_peak(info));
    json_count(json, "process_peak_before_bvh", (long)session->scene->load_peak);
    json_close(json, '{');
    json_text(json, "integrator", session->settings.integrator);
    char blind_to[BLIND_TEXT];
    blind_spots(session->scene->desc, &session->settings,
                settings_depth(&session->settings, session->scene), blind_to);
    json_text(json, "blind_to", blind_to);
    json_number(json, "seconds_load", session->load_seconds);
    json_number(json, "seconds_build", session->scene->load_seconds);
}

static void write_needs(struct json *json, const struct needs *needs)
{
    json_open(json, "needs", '[');
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (needs_get(needs, row))
            json_text(json, NULL, row->name);
    json_close(json, '[');
    json_open(json, "left_out", '{');
    for (const struct needs_row *row = needs_rows; row->name; row++)
        if (!needs_get(needs, row))
            json_text(json, row->name, row->reason);
    json_close(json, '{');
    json_flag(json, "keep_all", needs->keep_all);
}

static void write_place(struct json *json, const char *file, int line, int col)
{
    json_text(json, "file", file);
    json_count(json, "line", line);
    json_count(json, "col", col);
}

static void write_notes(struct json *json, const struct scene_desc *desc,
                        size_t note_count)
{
    json_open(json, "settings", '[');
    for (size_t i = 0; i < desc->setting_count; i++) {
        const struct setting_desc *s = &desc->settings[i];
        json_open(json, NULL, '{');
        json_text(json, "key", s->key);
        json_text(json, "value", s->value);
        write_place(json, s->place.file ? s->place.file : desc->path, s->place.line,
                    s->place.col);
        json_close(json, '{');
    }
    json_close(json, '[');
    json_open(json, "warnings", '[');
    for (size_t i = 0; i < desc->log.count; i++) {
        const struct log_note *note = &desc->log.notes[i];
        json_open(json, NULL, '{');
        json_text(json, "text", note->text);
        json_count(json, "count", note->count);
        json_flag(json, "loss", i < note_count && !note->remark);
        write_place(json, note->file, note->line, note->col);
        json_close(json, '{');
    }
    json_close(json, '[');
}

char *info_json(const struct info *info)
{
    struct json json = {0};
    json_open(&json, NULL, '{');
    json_flag(&json, "complete", info_is_complete(info));
    json_text(&json, "scene", info->session->scene->desc->path);
    write_film(&json, info->session);
    write_contents(&json, info);
    write_cost(&json, info);
    write_needs(&json, &info->session->scene->needs);
    write_notes(&json, info->session->scene->desc, info->session->note_count);
    json_close(&json, '{');
    return json.text.data;
}
