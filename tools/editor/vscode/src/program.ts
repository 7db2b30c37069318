// Runs the program once and reads the one document that it prints with --json. No shell is
// involved, so a name of a file is never anything but a name.

import { execFile } from 'node:child_process';
import { isAbsolute, join } from 'node:path';

/** One start of the program: what it is, its words, and the folder in which it runs. */
export interface Call {
  program: string;
  words: readonly string[];
  folder: string;
}

/** Registers what is to be done when the user cancels. */
export type OnCancel = (stop: () => void) => void;

export interface Answer {
  /** The exit code; null if a signal ended the program. */
  code: number | null;
  document: Record<string, unknown>;
  /** Remarks and warnings, as a terminal would show them. */
  remarks: string;
}

/** The program could not be started, or what it printed is no document. The text is for users. */
export class ProgramError extends Error {}

const maxOutput = 256 * 1024 * 1024;
const patienceMs = 10_000;

/** A path of the settings: names are looked for in PATH, paths begin at the workspace's folder. */
export function programOf(setting: string, folder: string): string {
  const path = setting.trim() === '' ? 'parallax' : setting.trim();
  return isAbsolute(path) || !path.includes('/') ? path : join(folder, path);
}

/**
 * Runs the program to its end. `onCancel` interrupts it (SIGINT), so that it says what it has; one
 * that does not end in ten seconds is killed.
 */
export function run(call: Call, onCancel?: OnCancel): Promise<Answer> {
  return new Promise((resolve, reject) => {
    let killing: NodeJS.Timeout | undefined;
    const child = execFile(
      call.program,
      [...call.words],
      { cwd: call.folder, maxBuffer: maxOutput, encoding: 'utf8', windowsHide: true, shell: false },
      (error, stdout, stderr) => {
        clearTimeout(killing);
        const reason = startProblem(call.program, error);
        if (reason !== undefined) {
          reject(new ProgramError(reason));
          return;
        }
        try {
          const document = documentOf(stdout, stderr);
          resolve({ code: child.exitCode, document, remarks: stderr });
        } catch (problem) {
          reject(problem);
        }
      },
    );
    // Without this a command that reads standard input would wait for ever.
    child.stdin?.end();
    onCancel?.(() => {
      child.kill('SIGINT');
      killing ??= setTimeout(() => child.kill('SIGKILL'), patienceMs);
    });
  });
}

function startProblem(program: string, error: (Error & { code?: unknown }) | null): string | undefined {
  if (error === null || typeof error.code !== 'string') return undefined;
  if (error.code === 'ENOENT') {
    return `${program} was not found. Install parallax, or set parallax.path.`;
  }
  if (error.code === 'EACCES') return `${program} may not be started. Check parallax.path.`;
  if (error.code === 'ERR_CHILD_PROCESS_STDIO_MAXBUFFER') {
    return 'The answer is longer than 256 MB. Ask for less, for instance for fewer traces.';
  }
  return `${program} could not be started: ${error.code}.`;
}

/** The document on standard output; without one, an error that says what standard error says. */
export function documentOf(stdout: string, stderr: string): Record<string, unknown> {
  let parsed: unknown;
  try {
    parsed = JSON.parse(stdout);
  } catch {
    const said = stderr.trim() || stdout.trim() || 'parallax printed nothing.';
    throw new ProgramError(said.length > 2000 ? `${said.slice(0, 2000)} ...` : said);
  }
  if (typeof parsed !== 'object' || parsed === null || Array.isArray(parsed)) {
    throw new ProgramError('parallax printed JSON that is no document. Is it another program?');
  }
  return parsed as Record<string, unknown>;
}
