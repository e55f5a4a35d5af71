// The commands of `coapt`, one file each. Each adds itself to the application and, when it runs, leaves
// its exit code and its document in the session. Bad input leaves a command as InputError.
#pragma once

namespace CLI {
class App;
}

namespace coapt::cli {

struct Session;

void add_solve_command(CLI::App& app, Session& session);
void add_check_command(CLI::App& app, Session& session);
void add_generate_command(CLI::App& app, Session& session);
void add_import_command(CLI::App& app, Session& session);
void add_chords_command(CLI::App& app, Session& session);
void add_export_command(CLI::App& app, Session& session);
void add_schema_command(CLI::App& app, Session& session);
void add_sensitivity_command(CLI::App& app, Session& session);
void add_intervene_command(CLI::App& app, Session& session);
void add_study_command(CLI::App& app, Session& session);
void add_mesh_study_command(CLI::App& app, Session& session);
void add_tune_command(CLI::App& app, Session& session);
void add_tune_regions_command(CLI::App& app, Session& session);
void add_compare_command(CLI::App& app, Session& session);
void add_register_command(CLI::App& app, Session& session);
void add_bench_command(CLI::App& app, Session& session);
void add_stress_command(CLI::App& app, Session& session);
void add_pages_command(CLI::App& app, Session& session);
void add_image_command(CLI::App& app, Session& session);
void add_phantom_command(CLI::App& app, Session& session);
void add_segment_command(CLI::App& app, Session& session);
void add_close_command(CLI::App& app, Session& session);

}  // namespace coapt::cli
