// SPDX-License-Identifier: GPL-3.0-or-later

// A type of Flamenco's jobs: a batch of bakes. It belongs into the folder `scripts` beside flamenco-manager.

const JOB_TYPE = {
    label: "RSIBR Bake",
    description: "Bake reflection maps, a task for each environment and method, and write one page of all",
    settings: [
        { key: "folder", type: "string", subtype: "dir_path", required: true, visible: "web",
          description: "Folder on shared storage that holds the batch and takes the maps" },
        { key: "batch", type: "string", required: true, visible: "web",
          description: "Name of the batch in the folder" },
        { key: "parts", type: "string", required: true, visible: "web",
          description: "Names of the batch's parts, with spaces between them" },
        { key: "program", type: "string", required: true, visible: "web",
          description: "What starts rsibr on a worker: a program and its arguments" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const page = author.Task("page", "misc");
    for (const part of settings.parts.split(" ")) {
        const task = author.Task(part, "blender");
        task.addCommand(batchCommand(settings, ["--part", part]));
        page.addDependency(task);
        job.addTask(task);
    }
    page.addCommand(batchCommand(settings, ["--page"]));
    job.addTask(page);
}

function batchCommand(settings, which) {
    const [exe, ...before] = shellSplit(settings.program);
    const batch = [
        "batch", `${settings.folder}/inputs/${settings.batch}.json`,
        "--output", `${settings.folder}/maps`,
        "--progress", "lines",
    ];
    return author.Command("exec", { exe: exe, args: [...before, ...batch, ...which] });
}
