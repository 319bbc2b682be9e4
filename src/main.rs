fn main() -> std::process::ExitCode {
    trimtab::cli::main()
}
