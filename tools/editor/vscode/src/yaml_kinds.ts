// Which schema a YAML file has. Scenarios have any name, so the keys at the outermost level tell.

const scenarioKeys = new Set([
  'plan', 'bind', 'constraints', 'horizon', 'world', 'regions', 'mapping', 'actions', 'sampling',
  'criterion', 'simulator', 'search', 'expect', 'execution', 'start_weights', 'until_covered',
]);
const gateKeys = new Set(['models', 'plans', 'traces', 'runs', 'rates', 'undecided']);
const gateValues = /\b(forbidden|allowed|not-weaker|not-shorter|not-wider|rerun|passes|worse)\b/;
const worldKeys = new Set(['robot', 'joints', 'friction', 'places', 'solver', 'floor_material', 'sdf', 'urdf', 'mjcf']);

/** The keys at the outermost level of a YAML text in block style, without those of its values. */
export function outermostKeys(text: string): string[] {
  return [...text.matchAll(/^([A-Za-z_]\w*)[ \t]*:(?=[ \t\r\n]|$)/gm)].map((found) => found[1] ?? '');
}

/** The name of the schema (`parallax schema NAME`); undefined for a file that is none of ours. */
export function schemaOf(text: string): string | undefined {
  const keys = new Set(outermostKeys(text));
  if (keys.has('cases')) return 'suite.yaml';
  if (keys.has('discrepancies')) return 'ledger.yaml';
  if (keys.has('quarantine')) return 'quarantine.yaml';
  const among = (known: ReadonlySet<string>): number => [...keys].filter((key) => known.has(key)).length;
  // Two keys, since `model` or `plan` alone may stand in files of any program.
  const isPart = keys.has('include') || keys.has('model');
  if (among(scenarioKeys) + (isPart ? 1 : 0) >= 2) return 'scenario.yaml';
  if (keys.has('bodies') && among(worldKeys) > 0) return 'world.yaml';
  if (keys.size > 0 && among(gateKeys) === keys.size && gateValues.test(text)) return 'gate.yaml';
  return undefined;
}
