// Which folders are runs, and how they ended.

/** Without folders that lie in others: a run keeps further simulations in journals of its own. */
export function outermost(folders: readonly string[]): string[] {
  const all = new Set(folders);
  return [...all].filter((folder) => {
    for (let at = folder.lastIndexOf('/'); at > 0; at = folder.lastIndexOf('/', at - 1)) {
      if (all.has(folder.slice(0, at))) return false;
    }
    return true;
  });
}

/** The verdict of a report.json; a run without a readable one was not finished. */
export function verdictOf(report: string): string {
  try {
    const parsed: unknown = JSON.parse(report);
    if (typeof parsed === 'object' && parsed !== null && 'verdict' in parsed) {
      return typeof parsed.verdict === 'string' ? parsed.verdict : 'not finished';
    }
  } catch {
    // Missing, or half written.
  }
  return 'not finished';
}
