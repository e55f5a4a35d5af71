// The commands of `coapt`, one file each. Each adds itself to the application and, when it runs, leaves
// its exit code in `exit_code`. Bad input leaves a command as InputError.
#pragma once

namespace CLI {
class App;
}

namespace coapt::cli {

void add_solve_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_generate_command(CLI::App& app, int& exit_code);
void add_import_command(CLI::App& app, int& exit_code);
void add_chords_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_schema_command(CLI::App& app, int& exit_code);
void add_sensitivity_command(CLI::App& app, int& exit_code);
void add_intervene_command(CLI::App& app, int& exit_code);
void add_study_command(CLI::App& app, int& exit_code);
void add_mesh_study_command(CLI::App& app, int& exit_code);
void add_tune_command(CLI::App& app, int& exit_code);
void add_tune_regions_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_register_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_stress_command(CLI::App& app, int& exit_code);
void add_segment_command(CLI::App& app, int& exit_code);
void add_close_command(CLI::App& app, int& exit_code);

}  // namespace coapt::cli
