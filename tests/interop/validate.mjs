// node validate.mjs MODULES FILE...: what Khronos' glTF-Validator says of each file, as one JSON list on stdout.
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {basename, dirname, join, resolve} from 'node:path';

const [modules, ...files] = process.argv.slice(2);
const validator = createRequire(join(resolve(modules), 'package.json'))('gltf-validator');

async function validated(file) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 1000,
    externalResourceFunction: uri => readFile(join(dirname(file), decodeURIComponent(uri))).then(b => new Uint8Array(b)),
  });
  const {numErrors, numWarnings, numInfos, numHints, messages} = report.issues;
  const severities = ['error', 'warning', 'info', 'hint'];
  return {
    file,
    errors: numErrors,
    warnings: numWarnings,
    infos: numInfos,
    hints: numHints,
    messages: messages.map(m => ({code: m.code, severity: severities[m.severity], text: m.message, at: m.pointer})),
  };
}

const reports = [];
for (const file of files) {
  try {
    reports.push(await validated(file));
  } catch (error) {
    reports.push({file, failed: String(error)});
  }
}
console.log(JSON.stringify(reports));
